// track_klt() against cv::calcOpticalFlowPyrLK (21 x 21, 3 levels above the image) on rendered motion with known flow.
#include "textplane/features/klt.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <opencv2/video/tracking.hpp>

#include "features/synthetic.hpp"
#include "opencv/as_mat.hpp"
#include "textplane/features/select.hpp"

namespace {

using namespace textplane;
using namespace textplane_test;

struct Score {
  double mean = 0, p90 = 0;
  int within_1px = 0, points = 0;
};

// Over the points that both trackers followed to within 3 px: a lost point counts against robustness, not accuracy.
Score score(const std::vector<double>& error, const std::vector<double>& other) {
  Score s;
  std::vector<double> common;
  for (std::size_t i = 0; i < error.size(); ++i) {
    s.within_1px += error[i] < 1 ? 1 : 0;
    if (error[i] < 3 && other[i] < 3) common.push_back(error[i]);
  }
  std::sort(common.begin(), common.end());
  s.points = static_cast<int>(common.size());
  for (const double e : common) s.mean += e / s.points;
  s.p90 = common[common.size() * 9 / 10];
  return s;
}

struct Scenario {
  const char* name;
  double angle, zoom, dx, dy, px, py;
  Light first, second;
};

void PrintTo(const Scenario& s, std::ostream* os) { *os << s.name; }

struct Points {
  std::vector<Vector2f> from;
  std::vector<cv::Point2f> cv_from;
  std::vector<Vector2d> truth;
};

// The corners whose whole patch at the finest level is inside both images.
Points inside_both(const std::vector<Corner>& corners, const Matrix3d& to_second, int width, int height) {
  Points out;
  const double margin = 15;
  for (const Corner& k : corners) {
    const Vector2d q = TexturedPlane::apply(to_second, {k.x, k.y});
    if (k.x < margin || k.y < margin || k.x > width - 1 - margin || k.y > height - 1 - margin) continue;
    if (q[0] < margin || q[1] < margin || q[0] > width - 1 - margin || q[1] > height - 1 - margin) continue;
    out.from.push_back({k.x, k.y});
    out.cv_from.emplace_back(k.x, k.y);
    out.truth.push_back(q);
  }
  return out;
}

class KltAgainstOpenCv : public testing::TestWithParam<Scenario> {};

TEST_P(KltAgainstOpenCv, AtLeastAsAccurateAndAsRobust) {
  const Scenario& c = GetParam();
  const int width = 640, height = 480;
  std::vector<double> ours, theirs;
  int accepted = 0, accepted_wrong = 0;
  for (std::uint32_t seed = 1; seed <= 3; ++seed) {
    const TexturedPlane plane(seed);
    const Matrix3d to_second = motion(c.angle, c.zoom, c.dx, c.dy, c.px, c.py, width, height);
    const Image<std::uint8_t> first = plane.render(Matrix3d::Identity(), width, height, c.first, 10 + seed);
    const Image<std::uint8_t> second = plane.render(to_second.inverse(), width, height, c.second, 20 + seed);

    std::vector<Corner> corners, strongest;
    ASSERT_TRUE(is_ok(detect_fast(first.view(), 20, true, corners)));
    select_spread(corners, width, height, 20, 400, {}, strongest);
    const auto [from, cv_from, truth] = inside_both(strongest, to_second, width, height);
    ASSERT_GT(from.size(), 200U);

    const Pyramid a(first.view(), 4), b(second.view(), 4);
    const int n = static_cast<int>(from.size());
    std::vector<KltResult> result(from.size()), checked(from.size());
    KltOptions one_way;  // OpenCV has no backward check either
    one_way.max_forward_backward = 0;
    track_klt(a, b, from.data(), nullptr, n, one_way, result.data());
    track_klt(a, b, from.data(), nullptr, n, KltOptions(), checked.data());
    std::vector<cv::Point2f> cv_to;
    std::vector<unsigned char> status;
    std::vector<float> residual;
    cv::calcOpticalFlowPyrLK(as_mat(first), as_mat(second), cv_from, cv_to, status, residual, cv::Size(21, 21), 3);

    for (std::size_t i = 0; i < from.size(); ++i) {
      const double lost = 1e3;
      const double e = (result[i].px.cast<double>() - truth[i]).norm();
      ours.push_back(is_ok(result[i].status) ? e : lost);
      accepted += is_ok(checked[i].status) ? 1 : 0;
      accepted_wrong += is_ok(checked[i].status) && e > 1 ? 1 : 0;
      theirs.push_back(status[i] ? (Vector2d(cv_to[i].x, cv_to[i].y) - truth[i]).norm() : lost);
    }
  }
  const Score mine = score(ours, theirs), cvs = score(theirs, ours);
  std::printf(
      "%-12s of %zu, %d common: textplane mean %.4f p90 %.4f within 1 px %d | OpenCV %.4f %.4f %d | accepted %d, wrong "
      "%d\n",
      c.name, ours.size(), mine.points, mine.mean, mine.p90, mine.within_1px, cvs.mean, cvs.p90, cvs.within_1px,
      accepted, accepted_wrong);
  EXPECT_LE(mine.mean, cvs.mean);
  EXPECT_LE(mine.p90, cvs.p90);
  EXPECT_GE(mine.within_1px, cvs.within_1px);
  EXPECT_GE(accepted, mine.within_1px * 9 / 10);
  EXPECT_LE(accepted_wrong, accepted / 100);
}

INSTANTIATE_TEST_SUITE_P(
    Rendered, KltAgainstOpenCv,
    testing::Values(Scenario{"steady", 0.01, 1.01, 5.3, -3.7, 1e-5, -1e-5, {}, {}},
                    Scenario{"noisy", 0.01, 1.01, 5.3, -3.7, 1e-5, -1e-5, {1, 0, 0, 0, 3}, {1, 0, 0, 0, 3}},
                    Scenario{"gain", 0.01, 1.01, 5.3, -3.7, 1e-5, -1e-5, {1, 0, 0, 0, 1}, {0.7, 25, 0, 0, 1}},
                    Scenario{
                        "slope", 0.02, 0.99, -8.2, 6.4, -2e-5, 1e-5, {0.9, 0, 4e-4, 0, 2}, {0.9, 0, -4e-4, 4e-4, 2}},
                    Scenario{"fast", 0.04, 1.03, 21.6, -14.3, 3e-5, 2e-5, {1, 0, 0, 0, 2}, {0.8, 10, 0, 0, 2}},
                    Scenario{"tilt", -0.06, 0.95, 3.1, 9.8, 1e-4, -6e-5, {1, 0, 0, 0, 2}, {1.1, -10, 2e-4, 0, 2}}),
    [](const auto& scenario) { return std::string(scenario.param.name); });

}  // namespace
