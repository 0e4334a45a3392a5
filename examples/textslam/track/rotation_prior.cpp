#include "textslam/track/rotation_prior.hpp"

#include <algorithm>
#include <cmath>

#include "textplane/photometry/candidates.hpp"
#include "textplane/photometry/residual.hpp"
#include "textplane/photometry/sample.hpp"

namespace textslam {
namespace {

constexpr double kDamping = 1.0001;    // of the diagonal: keeps the system regular
constexpr double kSettledTurn = 1e-5;  // radians
// Of a ray, along either axis of the image: 35 degrees. So much of a fisheye the fast kernels hold in one piece.
constexpr double kMostRay = 0.7;
// With t = 0 any plane in front of the camera is the plane at infinity.
const Vec3 kFarPlane = Vec3(0, 0, 1e-9);

// Two frames, compared on their coarsest common level as if all were infinitely far away.
class FrameAlignment {
 public:
  FrameAlignment(const Frame& a, const Frame& b, const CameraView& camera, const Parameters& parameters)
      : parameters_(parameters),
        level_(std::min({a.image->levels(), b.image->levels(), parameters.pyramid_levels}) - 1),
        camera_(camera.at_level(level_)),
        to_(b.image->level(level_)) {
    const textplane::ImageView8 from = a.image->level(level_);
    if (camera_.lens)
      take_straight(from);
    else
      take(from);
    workspace_.reserve(patch_.view().n);
    least_ = parameters.rotation_min_overlap * patch_.view().n;
  }

  // Gauss-Newton.
  RotationPrior descend(const Eigen::Matrix3d& start) {
    RotationPrior prior;
    prior.R_b_a = start;
    double best_cost = 0;
    Eigen::Matrix3d R = start;
    for (int iteration = 0; iteration < parameters_.rotation_iterations; ++iteration) {
      const auto eq = textplane::linearise<textplane::Parameters::pose>(
          textplane::ResidualRequest{input(), kFarPlane, SE3d{R, Vec3::Zero()}, options_}, workspace_);
      if (!textplane::is_ok(eq.status) || eq.visible < least_) break;
      if (iteration > 0 && eq.cost >= best_cost) break;
      best_cost = eq.cost;
      prior.R_b_a = R;
      prior.zncc = eq.zncc;
      Eigen::Matrix3d H = eq.H.bottomRightCorner<3, 3>();
      H.diagonal() *= kDamping;
      const textplane::Ldlt<double, 3> ldlt(H);
      if (!ldlt.ok()) break;
      const Vec3 turn = -ldlt.solve(eq.b.tail<3>());
      R = textplane::so3_exp(turn) * R;
      if (turn.norm() < kSettledTurn) break;
    }
    return prior;
  }

  // The best rotation on a grid of shifts of the image, with a few rolls.
  Eigen::Matrix3d search() {
    options_.min_visible = std::max(options_.min_visible, static_cast<int>(least_));
    const double step = parameters_.rotation_search_step;
    const int most = static_cast<int>(parameters_.rotation_search_share * to_.width() / step);
    std::vector<SE3d> tried;
    for (const double roll : {0.0, -parameters_.rotation_search_roll, parameters_.rotation_search_roll})
      for (int y = -most; y <= most; ++y)
        for (int x = -most; x <= most; ++x) {
          const Vec3 turn(-y * step / camera_.pinhole.fy, x * step / camera_.pinhole.fx, roll);
          tried.push_back({textplane::so3_exp(turn), Vec3::Zero()});
        }
    std::vector<float> zncc(tried.size());
    textplane::zncc_candidates(input(), kFarPlane, tried.data(), static_cast<int>(tried.size()), options_, workspace_,
                               zncc.data());
    return tried[static_cast<std::size_t>(std::max_element(zncc.begin(), zncc.end()) - zncc.begin())].R;
  }

 private:
  textplane::PhotometricInput input() const {
    return {patch_.view(), camera_.pinhole, camera_.pinhole, to_, {}, camera_.lens};
  }
  void take(const textplane::ImageView8& from) {
    const int step = parameters_.rotation_pixel_step;
    for (int y = 1; y + 1 < from.height(); y += step)
      for (int x = 1; x + 1 < from.width(); x += step) add(x, y, static_cast<float>(from(x, y)));
  }
  // Pixels of the undistorted image, as the lens shows them.
  void take_straight(const textplane::ImageView8& from) {
    const Pinhole<double>& c = camera_.pinhole;
    const int step = parameters_.rotation_pixel_step;
    const double reach_x = kMostRay * c.fx, reach_y = kMostRay * c.fy;
    for (int y = static_cast<int>(std::ceil(c.cy - reach_y)); y <= c.cy + reach_y; y += step)
      for (int x = static_cast<int>(std::ceil(c.cx - reach_x)); x <= c.cx + reach_x; x += step) {
        const Vec3 ray = c.unproject({x, y});
        float value = 0;
        if (!camera_.in_domain(ray)) continue;
        const Vec2f px = camera_.project(ray).cast<float>();
        if (textplane::sample_bilinear(from, px.x(), px.y(), &value)) add(x, y, value);
      }
  }
  void add(int x, int y, float value) {
    patch_.x.push_back(static_cast<float>(x));
    patch_.y.push_back(static_cast<float>(y));
    patch_.intensity.push_back(value);
  }

  const Parameters& parameters_;
  int level_;
  CameraView camera_;
  textplane::ImageView8 to_;
  textplane::PatchLevel patch_;
  textplane::PhotometricWorkspace workspace_;
  textplane::PhotometricOptions options_;
  double least_ = 0;
};

}  // namespace

RotationPrior align_rotation(const Frame& a, const Frame& b, const CameraView& camera, const Eigen::Matrix3d& start,
                             const Parameters& parameters) {
  return FrameAlignment(a, b, camera, parameters).descend(start);
}

RotationPrior find_rotation(const Frame& a, const Frame& b, const CameraView& camera, const Eigen::Matrix3d& start,
                            const Parameters& parameters) {
  FrameAlignment alignment(a, b, camera, parameters);
  const RotationPrior near = alignment.descend(start);
  if (near.zncc > parameters.rotation_clear_zncc) return near;
  const RotationPrior far = alignment.descend(alignment.search());
  return far.zncc > near.zncc ? far : near;
}

}  // namespace textslam
