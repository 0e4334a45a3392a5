// Planarity: how far a text is bent, as its images show it. A label round a tin and a carton's edge look like a plane
// from near the host, and like nothing from elsewhere.
//
// The text is cut into parts, each with a plane of its own. What may differ between them is one quadratic form of the
// inverse depth over the text, solved for together with the plane, from all views.
#ifndef TEXTPLANE_LANDMARKS_PLANARITY_HPP
#define TEXTPLANE_LANDMARKS_PLANARITY_HPP

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "textplane/geometry/plane.hpp"
#include "textplane/geometry/quad.hpp"
#include "textplane/photometry/photometric_workspace.hpp"
#include "textplane/photometry/residual.hpp"
#include "textplane/solver/jackknife.hpp"
#include "textplane/solver/plane.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// A bend across a text, as the tangent of the turn of its normal from one end to the other; positive where the middle
/// is nearest. Along the lines, and across them.
struct Bend {
  Vector2<double> value = Vector2<double>::Zero();  ///< Along, across.
  Vector2<double> sigma = Vector2<double>::Zero();  ///< Their standard deviations.
  /// Of theta, by bends that are larger than the views make likely. Errors that bend a plane turn it as well.
  Matrix3<double> doubt = Matrix3<double>::Zero();
  double explained = 0;  ///< Share of the images' disagreement with the plane that the bend explains.
};

namespace detail {
constexpr int kBendColumns = 4, kBendRows = 2, kBendParts = kBendColumns * kBendRows;
constexpr int kBendIterations = 5;
constexpr double kBendPriorSigma = 2;  // of a bend: no image tells how a single line is bent across
constexpr std::size_t kBendMinPixels = 8;
// An end that is nearer turns a plane by a fourth of what two ends bend it by.
constexpr double kBendOfTurn = 4;

// A text's own coordinates: (u, v) in [-1, 1] along and across its lines.
TEXTPLANE_DEFERRED
struct TextAxes {
  Vector2<Real> centre;
  FixedMatrix<Real, 2, 2> to_uv;  // of px about the centre
  Vector2<Real> slope;  // turn of the normal from end to end (tangent), for a relative inverse depth of u^2 or v^2
};

TEXTPLANE_DEFERRED
inline bool axes_of(const Quad<Real>& quad, const Vector3<Real>& theta, const Pinhole<Real>& camera,
                    TextAxes<Real>* axes) {
  const auto& c = quad.corner;
  FixedMatrix<Real, 2, 2> half;
  half.col(0) = 0.25 * (c[1] - c[0] + c[2] - c[3]);
  half.col(1) = 0.25 * (c[3] - c[0] + c[2] - c[1]);
  if (!(std::abs(half.determinant()) > 1)) return false;
  axes->centre = centroid(quad);
  axes->to_uv = half.inverse();
  const Vector3<Real> normal = plane_normal(theta);
  const Vector3<Real> p = plane_point(theta, camera.unproject(axes->centre));
  for (int k = 0; k < 2; ++k) {
    const Vector3<Real> q = plane_point(theta, camera.unproject(Vector2<Real>(axes->centre + half.col(k))));
    // The surface leaves the plane by -p u^2 along the ray.
    axes->slope[k] = 4 * std::abs(normal.dot(p)) / (q - p).norm();
  }
  return axes->slope.allFinite();
}

// Planes of inverse depth 1, du, dv times that of the text's centre become planes theta.
TEXTPLANE_DEFERRED
inline Vector3<Real> plane_of(const TextAxes<Real>& axes, const Pinhole<Real>& camera, double rho, double at_centre,
                              const Vector2<Real>& by_uv) {
  const Vector2<Real> by_px = axes.to_uv.transpose() * by_uv;
  const double constant = at_centre - by_px.dot(axes.centre);
  return rho * Vector3<Real>(by_px.x() * camera.fx, by_px.y() * camera.fy,
                             constant + by_px.x() * camera.cx + by_px.y() * camera.cy);
}

// d theta of a part / d (theta, bends): in each part the quadratic form is its tangent plane.
TEXTPLANE_DEFERRED
inline FixedMatrix<Real, 3, 6> part_jacobian(const TextAxes<Real>& axes, const Pinhole<Real>& camera, double rho,
                                             const Vector2<Real>& at) {
  FixedMatrix<Real, 3, 6> J;
  J.template leftCols<3>().setIdentity();
  const double u = at.x(), v = at.y();
  J.col(3) = plane_of(axes, camera, rho, -u * u, {2 * u, 0}) / axes.slope.x();
  J.col(4) = plane_of(axes, camera, rho, -v * v, {0, 2 * v}) / axes.slope.y();
  J.col(5) = plane_of(axes, camera, rho, -u * v, {v, u}) / axes.slope.minCoeff();
  return -J;
}

TEXTPLANE_DEFERRED
inline void append(const PatchLevel& from, std::size_t i, PatchLevel* to) {
  to->x.push_back(from.x[i]);
  to->y.push_back(from.y[i]);
  to->intensity.push_back(from.intensity[i]);
  to->gx.push_back(from.gx[i]);
  to->gy.push_back(from.gy[i]);
}

TEXTPLANE_DEFERRED
inline std::array<TextPatch, kBendParts> parts_of(const TextPatch& patch, const TextAxes<Real>& axes) {
  std::array<TextPatch, kBendParts> parts;
  for (TextPatch& part : parts) {
    part.quad = patch.quad;
    part.camera = patch.camera;
    part.status = patch.status;
    part.rows = patch.rows;
    part.levels.resize(1);
  }
  const PatchLevel& all = patch.levels.front();
  for (std::size_t i = 0; i < all.x.size(); ++i) {
    const Vector2<Real> px(static_cast<double>(all.x[i]), static_cast<double>(all.y[i]));
    const Vector2<Real> uv = axes.to_uv * (px - axes.centre);
    const auto cell = [](double at, int n) {
      return static_cast<std::size_t>(std::clamp(static_cast<int>(0.5 * (at + 1) * n), 0, n - 1));
    };
    append(all, i, &parts[cell(uv.y(), kBendRows) * kBendColumns + cell(uv.x(), kBendColumns)].levels.front());
  }
  for (TextPatch& part : parts) part.levels.front().find_bounds();
  return parts;
}

}  // namespace detail

/// The bend of the text in `patch` about the plane `theta`, by targets that hold its pixels on one level
/// (target.patch). `camera`: of the host, and of targets without their own. `sigmas` of a bend cause no doubt. False
/// where they do not tell. `workspace` is reserved for the patch.
TEXTPLANE_DEFERRED
bool bend_of(const TextPatch& patch, const Vector3<double>& theta, const std::vector<PlaneTarget>& targets,
             const Pinhole<double>& camera, double sigmas, PhotometricWorkspace& workspace, Bend* bend) {
  detail::TextAxes<Real> axes;
  if (patch.levels.empty() || !detail::axes_of(patch.quad, theta, camera, &axes)) return false;
  const double rho = inverse_depth<Real>(theta, camera.unproject(axes.centre));
  std::vector<std::array<TextPatch, detail::kBendParts>> parts;
  for (const PlaneTarget& target : targets)
    parts.push_back(detail::parts_of(target.patch ? *target.patch : patch, axes));

  Vector6<Real> x = Vector6<Real>::Zero(), information = Vector6<Real>::Zero();
  information.template tail<3>().setConstant(1 / (detail::kBendPriorSigma * detail::kBendPriorSigma));
  std::vector<GroupEquations<6>> views;
  double flat = 0, error = 0;
  for (int iteration = 0; iteration <= detail::kBendIterations; ++iteration) {
    views.assign(targets.size(), {});
    error = 0;
    FixedMatrix<Real, 6, 6> H = information.asDiagonal();
    Vector6<Real> b = information.cwiseProduct(x);
    for (std::size_t t = 0; t < targets.size(); ++t) {
      for (int k = 0; k < detail::kBendParts; ++k) {
        const TextPatch& part = parts[t][static_cast<std::size_t>(k)];
        if (part.levels.front().x.size() < detail::kBendMinPixels) continue;
        const Vector2<Real> at((2.0 * (k % detail::kBendColumns) + 1) / detail::kBendColumns - 1,
                               (2.0 * (k / detail::kBendColumns) + 1) / detail::kBendRows - 1);
        const FixedMatrix<Real, 3, 6> J = detail::part_jacobian(axes, camera, rho, at);
        const auto input =
            photometric_input(part, 0, targets[t].image, targets[t].camera ? *targets[t].camera : CameraView(camera));
        const auto sums = linearise<Parameters::plane>(
            ResidualRequest{input, Vector3<Real>(theta + J * x), targets[t].T_t_h}, workspace);
        if (!is_ok(sums.status)) continue;
        error += sums.visible * sums.error;
        views[t].H += sums.visible * J.transpose() * sums.H * J;
        views[t].b += sums.visible * J.transpose() * sums.b;
      }
      H += views[t].H;
      b += views[t].b;
    }
    if (iteration == 0) flat = error;
    const Ldlt<Real, 6> system(H, 1e-12);
    if (!system.ok()) return false;
    if (iteration < detail::kBendIterations) x -= system.solve(b);
    if (!all_finite(x)) return false;
  }
  views.push_back({FixedMatrix<Real, 6, 6>(information.asDiagonal()), information.cwiseProduct(x)});
  const FixedMatrix<Real, 6, 6> covariance = jackknife_covariance(views);
  bend->explained = flat > 0 ? 1 - error / flat : 0;
  bend->value = x.template segment<2>(3);
  bend->sigma = covariance.diagonal().template segment<2>(3).cwiseMax(0.0).cwiseSqrt();
  bend->doubt.setZero();
  for (int k = 0; k < 2; ++k) {
    const double excess = (std::max)(0.0, std::abs(bend->value[k]) - sigmas * bend->sigma[k]) / detail::kBendOfTurn;
    const Vector3<Real> turned = excess * detail::kBendOfTurn / axes.slope[k] *
                                 detail::plane_of(axes, camera, rho, 0, Vector2<Real>(Vector2<Real>::Unit(k)));
    bend->doubt += turned * turned.transpose();
  }
  return true;
}

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_LANDMARKS_PLANARITY_HPP
