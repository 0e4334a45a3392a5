#include "textslam/text/text_planarity.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "textplane/geometry/plane.hpp"
#include "textplane/geometry/quad.hpp"
#include "textplane/photometry/residual.hpp"
#include "textslam/text/jackknife.hpp"

namespace textslam {
namespace {

constexpr int kColumns = 4, kRows = 2, kParts = kColumns * kRows;
constexpr int kIterations = 5;
constexpr double kPriorSigma = 2;  // of a bend: no image tells how a single line is bent across
constexpr std::size_t kMinPixels = 8;
// An end that is nearer turns a plane by a fourth of what two ends bend it by.
constexpr double kBendOfTurn = 4;

using Vec6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Matrix36 = Eigen::Matrix<double, 3, 6>;

// A text's own coordinates: (u, v) in [-1, 1] along and across its lines.
struct Axes {
  Vec2 centre;
  Eigen::Matrix2d to_uv;  // of px about the centre
  Vec2 slope;             // turn of the normal from end to end (tangent), for a relative inverse depth of u^2 or v^2
};

bool axes_of(const Quad<double>& quad, const Vec3& theta, const Pinhole<double>& camera, Axes* axes) {
  const auto& c = quad.corner;
  Eigen::Matrix2d half;
  half.col(0) = 0.25 * (c[1] - c[0] + c[2] - c[3]);
  half.col(1) = 0.25 * (c[3] - c[0] + c[2] - c[1]);
  if (!(std::abs(half.determinant()) > 1)) return false;
  axes->centre = textplane::centroid(quad);
  axes->to_uv = half.inverse();
  const Vec3 normal = textplane::plane_normal(theta);
  const Vec3 p = textplane::plane_point(theta, camera.unproject(axes->centre));
  for (int k = 0; k < 2; ++k) {
    const Vec3 q = textplane::plane_point(theta, camera.unproject(Vec2(axes->centre + half.col(k))));
    // The surface leaves the plane by -p u^2 along the ray.
    axes->slope[k] = 4 * std::abs(normal.dot(p)) / (q - p).norm();
  }
  return axes->slope.allFinite();
}

// Planes of inverse depth 1, du, dv times that of the text's centre become planes theta.
Vec3 plane_of(const Axes& axes, const Pinhole<double>& camera, double inverse_depth, double at_centre,
              const Vec2& by_uv) {
  const Vec2 by_px = axes.to_uv.transpose() * by_uv;
  const double constant = at_centre - by_px.dot(axes.centre);
  return inverse_depth *
         Vec3(by_px.x() * camera.fx, by_px.y() * camera.fy, constant + by_px.x() * camera.cx + by_px.y() * camera.cy);
}

// d theta of a part / d (theta, bends): in each part the quadratic form is its tangent plane.
Matrix36 part_jacobian(const Axes& axes, const Pinhole<double>& camera, double inverse_depth, const Vec2& at) {
  Matrix36 J;
  J.leftCols<3>().setIdentity();
  const double u = at.x(), v = at.y();
  J.col(3) = plane_of(axes, camera, inverse_depth, -u * u, {2 * u, 0}) / axes.slope.x();
  J.col(4) = plane_of(axes, camera, inverse_depth, -v * v, {0, 2 * v}) / axes.slope.y();
  J.col(5) = plane_of(axes, camera, inverse_depth, -u * v, {v, u}) / axes.slope.minCoeff();
  return -J;
}

void append(const textplane::PatchLevel& from, std::size_t i, textplane::PatchLevel* to) {
  to->x.push_back(from.x[i]);
  to->y.push_back(from.y[i]);
  to->intensity.push_back(from.intensity[i]);
  to->gx.push_back(from.gx[i]);
  to->gy.push_back(from.gy[i]);
}

std::array<textplane::TextPatch, kParts> parts_of(const textplane::TextPatch& patch, const Axes& axes) {
  std::array<textplane::TextPatch, kParts> parts;
  for (textplane::TextPatch& part : parts) {
    part.quad = patch.quad;
    part.camera = patch.camera;
    part.status = patch.status;
    part.levels.resize(1);
  }
  const textplane::PatchLevel& all = patch.levels.front();
  for (std::size_t i = 0; i < all.x.size(); ++i) {
    const Vec2 px(static_cast<double>(all.x[i]), static_cast<double>(all.y[i]));
    const Vec2 uv = axes.to_uv * (px - axes.centre);
    const auto cell = [](double at, int n) {
      return static_cast<std::size_t>(std::clamp(static_cast<int>(0.5 * (at + 1) * n), 0, n - 1));
    };
    append(all, i, &parts[cell(uv.y(), kRows) * kColumns + cell(uv.x(), kColumns)].levels.front());
  }
  for (textplane::TextPatch& part : parts) part.levels.front().find_bounds();
  return parts;
}

}  // namespace

bool bend_of(const textplane::TextPatch& patch, const Vec3& theta, const std::vector<textplane::PlaneTarget>& targets,
             const Pinhole<double>& camera, double sigmas, textplane::PhotometricWorkspace& workspace, Bend* bend) {
  Axes axes;
  if (patch.levels.empty() || !axes_of(patch.quad, theta, camera, &axes)) return false;
  const double inverse_depth = textplane::inverse_depth(theta, camera.unproject(axes.centre));
  std::vector<std::array<textplane::TextPatch, kParts>> parts;
  for (const textplane::PlaneTarget& target : targets)
    parts.push_back(parts_of(target.patch ? *target.patch : patch, axes));

  Vec6 x = Vec6::Zero(), information = Vec6::Zero();
  information.tail<3>().setConstant(1 / (kPriorSigma * kPriorSigma));
  std::vector<GroupEquations<6>> views;
  double flat = 0, error = 0;
  for (int iteration = 0; iteration <= kIterations; ++iteration) {
    views.assign(targets.size(), {});
    error = 0;
    Matrix6 H = information.asDiagonal();
    Vec6 b = information.cwiseProduct(x);
    for (std::size_t t = 0; t < targets.size(); ++t) {
      for (int k = 0; k < kParts; ++k) {
        const textplane::TextPatch& part = parts[t][static_cast<std::size_t>(k)];
        if (part.levels.front().x.size() < kMinPixels) continue;
        const Vec2 at((2.0 * (k % kColumns) + 1) / kColumns - 1, (2.0 * (k / kColumns) + 1) / kRows - 1);
        const Matrix36 J = part_jacobian(axes, camera, inverse_depth, at);
        const auto input = textplane::photometric_input(part, 0, targets[t].image, camera);
        const auto sums = textplane::linearise<textplane::Parameters::plane>(
            textplane::ResidualRequest{input, Vec3(theta + J * x), targets[t].T_t_h}, workspace);
        if (!textplane::is_ok(sums.status)) continue;
        error += sums.visible * sums.error;
        views[t].H += sums.visible * J.transpose() * sums.H * J;
        views[t].b += sums.visible * J.transpose() * sums.b;
      }
      H += views[t].H;
      b += views[t].b;
    }
    if (iteration == 0) flat = error;
    const textplane::Ldlt<double, 6> system(H, 1e-12);
    if (!system.ok()) return false;
    if (iteration < kIterations) x -= system.solve(b);
    if (!textplane::all_finite(x)) return false;
  }
  views.push_back({Matrix6(information.asDiagonal()), information.cwiseProduct(x)});
  const Matrix6 covariance = jackknife_covariance(views);
  bend->explained = flat > 0 ? 1 - error / flat : 0;
  bend->value = x.segment<2>(3);
  bend->sigma = covariance.diagonal().segment<2>(3).cwiseMax(0.0).cwiseSqrt();
  bend->doubt.setZero();
  for (int k = 0; k < 2; ++k) {
    const double excess = std::max(0.0, std::abs(bend->value[k]) - sigmas * bend->sigma[k]) / kBendOfTurn;
    const Vec3 turned = excess * kBendOfTurn / axes.slope[k] * plane_of(axes, camera, inverse_depth, 0, Vec2::Unit(k));
    bend->doubt += turned * turned.transpose();
  }
  return true;
}

}  // namespace textslam
