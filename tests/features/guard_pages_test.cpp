// track_klt() and the patches of points read no byte outside their images: these end, or begin, at pages that may not
// be touched, on every level, and the points lie on and near every border. A read too far ends the program.
#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <vector>

#include "support/guarded.hpp"
#include "support/random.hpp"
#include "support/targets.hpp"
#include "textplane/features/klt.hpp"

namespace klt_guard_pages_test {
namespace tp = textplane;
using namespace textplane_test;

// Levels that halve, each in guarded memory of its own; the rows lie `gap` bytes apart. Noise, so that points have
// texture in both directions.
struct GuardedPyramid {
  std::vector<std::unique_ptr<Guarded<std::uint8_t>>> memory;
  tp::PyramidView at_end, at_front;

  GuardedPyramid(int width, int height, int gap, unsigned seed) {
    Random random(seed);
    for (std::size_t l = 0; l < 3 && width > 0 && height > 0; ++l, width /= 2, height /= 2) {
      const int stride = width + gap;
      memory.push_back(
          std::make_unique<Guarded<std::uint8_t>>(static_cast<std::size_t>((height - 1) * stride + width)));
      const Guarded<std::uint8_t>& m = *memory.back();
      for (std::size_t i = 0; i < m.size(); ++i)
        m.data()[i] = m.front()[i] = static_cast<std::uint8_t>(random.integer(0, 255));
      at_end.level[l] = tp::ImageView8(m.data(), width, height, stride);
      at_front.level[l] = tp::ImageView8(m.front(), width, height, stride);
      at_end.levels = at_front.levels = static_cast<int>(l) + 1;
    }
  }
};

// Points whose patch of this radius touches a border, is a fraction of a pixel off it, or lies anywhere.
std::vector<tp::Vector2<float>> points(int width, int height, int radius, Random& random) {
  std::vector<tp::Vector2<float>> out;
  const auto place = [&](int side) {
    const double margin = radius + 1, inside = random.uniform(0, side - 1), nudge = random.uniform(-0.6, 0.6);
    const double values[] = {margin, side - 1 - margin, margin + nudge, side - 1 - margin + nudge, inside,
                             nudge,  side - 1 + nudge};
    return static_cast<float>(values[random.integer(0, 6)]);
  };
  for (int i = 0; i < 40; ++i) {
    const float x = place(width);
    out.push_back({x, place(height)});
  }
  return out;
}

int run(const tp::PyramidView& from, const tp::PyramidView& to, int radius, Random& random) {
  const tp::ImageView8& image = from.level[0];
  const std::vector<tp::Vector2<float>> at = points(image.width(), image.height(), radius, random);
  const auto n = static_cast<int>(at.size());
  std::vector<tp::Vector2<float>> guess;
  for (const tp::Vector2<float>& p : at) {
    const auto dx = static_cast<float>(random.uniform(-2, 2)), dy = static_cast<float>(random.uniform(-2, 2));
    guess.push_back({p[0] + dx, p[1] + dy});
  }
  tp::KltOptions options;
  options.radius = radius;
  options.min_eigenvalue = 0;
  std::vector<tp::KltResult> out(at.size());
  tp::track_klt(from, to, at.data(), nullptr, n, options, out.data());
  int tracked = 0;
  for (const tp::KltResult& r : out) tracked += tp::is_ok(r.status);
  tp::track_klt(from, to, at.data(), guess.data(), n, options, out.data());
  for (const tp::Vector2<float>& p : at) {
    tp::PointPatch patch;
    Eigen::Matrix2f A = Eigen::Matrix2f::Identity();
    A(0, 1) = static_cast<float>(random.uniform(-0.3, 0.3));
    if (tp::is_ok(tp::extract_point_patch(image, p, A, radius, &patch)))
      tp::align_point_patch(patch, to.level[0], p, options);
  }
  return tracked;
}

TEST(KltGuardPages, EveryBorderAndRadius) {
  Random random(1);
  for (const simd::Target target : testable_targets()) {
    const TargetScope scope(target);
    int tracked = 0;
    for (const auto& [width, height] : {std::pair<int, int>{23, 23}, {40, 29}, {67, 51}})
      for (const int gap : {0, 5}) {
        const GuardedPyramid pyramid(width, height, gap, static_cast<unsigned>(width));
        for (int radius = 1; radius <= tp::kMaxPatchRadius; ++radius) {
          tracked += run(pyramid.at_end, pyramid.at_end, radius, random);
          tracked += run(pyramid.at_front, pyramid.at_front, radius, random);
        }
      }
    EXPECT_GT(tracked, 500) << simd::to_string(target);
  }
}

// That the pages are where they should be: of an image that claims a row more, that row is read.
TEST(KltGuardPagesDeathTest, AnImageThatIsTooTallIsNoticed) {
  const GuardedPyramid pyramid(40, 29, 0, 1);
  tp::PyramidView taller = pyramid.at_end;
  taller.levels = 1;
  taller.level[0] = tp::ImageView8(pyramid.at_end.level[0].data(), 40, 30, 40);
  const tp::Vector2<float> at(20, 19);  // the last row of a patch of radius 9 is the one before the last
  for (const simd::Target target : testable_targets()) {
    const TargetScope scope(target);
    tp::KltResult result;
    EXPECT_DEATH(tp::track_klt(taller, taller, &at, nullptr, 1, {}, &result), "");
  }
}

}  // namespace klt_guard_pages_test
