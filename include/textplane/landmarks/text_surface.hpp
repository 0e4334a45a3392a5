// The surface that a text lies on, as a page or a board. Beside a small text, map points determine the plane best.
#ifndef TEXTPLANE_LANDMARKS_TEXT_SURFACE_HPP
#define TEXTPLANE_LANDMARKS_TEXT_SURFACE_HPP

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "textplane/core/order.hpp"
#include "textplane/geometry/quad_projection.hpp"
#include "textplane/landmarks/text_view.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// A map point in or beside a text, in the frame of the text's host.
struct SurfacePoint {
  Vector3<double> p = Vector3<double>::Zero();  ///< Position.
  double sigma = 0;   ///< Across the plane: of the point and of the relief of the surface there.
  double beside = 0;  ///< Distance from the text, along its plane; 0 within it.
};

/// The points of a map by their index, wherever they are kept. Not owning, like a view.
class PointLookup {
 public:
  /// `keeper` outlives the lookup and has
  ///   int text_point_count() const
  ///   bool text_point(int i, Vector3<double>* p_w) const    false: there is none, or a bad one
  ///   double text_point_variance(int i, const Vector3<double>& direction_w) const    not positive: not known
  template <class Keeper>
  explicit PointLookup(const Keeper& keeper) noexcept
      : keeper_(&keeper),
        count_([](const void* k) { return static_cast<const Keeper*>(k)->text_point_count(); }),
        position_(
            [](const void* k, int i, Vector3<double>* p) { return static_cast<const Keeper*>(k)->text_point(i, p); }),
        variance_([](const void* k, int i, const Vector3<double>& d) {
          return static_cast<const Keeper*>(k)->text_point_variance(i, d);
        }) {}

  int count() const { return count_(keeper_); }                                            ///< Indices are below it.
  bool position(int i, Vector3<double>* p_w) const { return position_(keeper_, i, p_w); }  ///< In the world.
  /// Of point i along a unit vector of the world; not positive where it is not known.
  double variance(int i, const Vector3<double>& direction_w) const { return variance_(keeper_, i, direction_w); }

 private:
  const void* keeper_;
  int (*count_)(const void*);
  bool (*position_)(const void*, int, Vector3<double>*);
  double (*variance_)(const void*, int, const Vector3<double>&);
};

/// The points within surface_reach of a text with a plane, of those whose variance is known.
TEXTPLANE_DEFERRED
std::vector<SurfacePoint> points_beside(const TextOptions& options, const PointLookup& points, const SE3d& T_w_h,
                                        const TextObject& text) {
  std::vector<SurfacePoint> beside_it;
  std::array<Vector3<Real>, 4> c;
  if (!is_ok(text_corners(text, &c))) return beside_it;
  const Vector3<Real> normal = plane_normal(text.theta), centre = 0.25 * (c[0] + c[1] + c[2] + c[3]);
  const Vector3<Real> across = 0.5 * (c[1] - c[0] + c[2] - c[3]), down = 0.5 * (c[3] - c[0] + c[2] - c[1]);
  const Vector3<Real> right = across.normalized(), below = normal.cross(right);
  const double reach = options.surface_reach * (std::max)(across.norm(), down.norm());

  const SE3d T_h_w = T_w_h.inverse();
  for (int i = 0; i < points.count(); ++i) {
    Vector3<Real> p_w;
    if (!points.position(i, &p_w)) continue;
    const Vector3<Real> p = T_h_w * p_w, offset = p - centre;
    const double beside = std::hypot((std::max)(0.0, std::abs(right.dot(offset)) - 0.5 * across.norm()),
                                     (std::max)(0.0, std::abs(below.dot(offset)) - 0.5 * down.norm()));
    if (!(p.z() > 0) || !(beside <= reach) || !(std::abs(normal.dot(offset)) <= reach)) continue;
    const double variance = points.variance(i, T_w_h.R * normal);
    if (variance > 0)
      beside_it.push_back({p, std::hypot(std::sqrt(variance), options.surface_relief * beside), beside});
  }
  return beside_it;
}

namespace detail {
constexpr double kMinPivot = 1e-12;  // a plane known much better in one direction than in another is still known

// Covariance of theta where the plane goes through a point and its normal is known to sigma, radians.
TEXTPLANE_DEFERRED
inline Matrix3<Real> turned_about(const Vector3<Real>& theta, const Vector3<Real>& point, double sigma) {
  const Vector3<Real> n = plane_normal(theta), side = n.unitOrthogonal(), other = n.cross(side);
  const double distance = n.dot(point);
  Matrix3<Real> covariance = Matrix3<Real>::Zero();
  for (const Vector3<Real>& turn : {side, other}) {
    const Vector3<Real> d = sigma / distance * (turn - turn.dot(point) / distance * n);  // theta = n / (n^T point)
    covariance += d * d.transpose();
  }
  return covariance;
}

// Where a plane is known by a guess alone: its slant in radians, its distance as a share.
TEXTPLANE_DEFERRED
inline Matrix3<Real> guessed(const Vector3<Real>& theta, const Vector3<Real>& centre, double turn, double distance) {
  return turned_about(theta, centre, turn) + distance * distance * theta * theta.transpose();
}
}  // namespace detail

/// Theta and covariance from what was known and from the points. The surface may be bent about `centre`, the text's, on
/// the plane (surface_bend). Points beyond surface_sigmas are down-weighted (Tukey), by the sigmas of the point and of
/// the plane there. False, and nothing changed, with weights below surface_min_points.
TEXTPLANE_DEFERRED
bool fit_to_surface(const std::vector<SurfacePoint>& points, const Vector3<double>& centre, const TextOptions& options,
                    Vector3<double>* theta, Matrix3<double>* covariance) {
  const Ldlt<Real, 3> prior(*covariance, detail::kMinPivot);
  if (!prior.ok()) return false;
  const Matrix3<Real> known = prior.inverse();
  const Matrix3<Real> bend = detail::turned_about(*theta, centre, detail::radians(options.surface_bend));
  Vector3<Real> x = *theta;
  Matrix3<Real> C = *covariance;
  const double sigmas = options.surface_sigmas;
  double used = 0;
  for (int round = 0; round < options.surface_rounds; ++round) {
    Matrix3<Real> information = Matrix3<Real>::Zero();
    Vector3<Real> gradient = Vector3<Real>::Zero();
    used = 0;
    for (const SurfacePoint& point : points) {
      const Vector3<Real>& p = point.p;
      const double error = 1 - x.dot(p), variance = x.squaredNorm() * point.sigma * point.sigma;
      const double squared = error * error / (sigmas * sigmas * (variance + p.dot(C * p)));
      if (!(squared < 1)) continue;
      const double weight = (1 - squared) * (1 - squared);
      information += weight / variance * p * p.transpose();
      gradient += weight / variance * error * p;
      used += weight;
    }
    // The bend is common to all points: (information^-1 + bend)^-1, in a form where neither need be regular.
    const Matrix3<Real> together = (Matrix3<Real>::Identity() + information * bend).inverse();
    const Matrix3<Real> both = known + together * information;
    const Ldlt<Real, 3> system(0.5 * (both + both.transpose()), detail::kMinPivot);
    if (!system.ok()) return false;
    x += system.solve(known * (*theta - x) + together * gradient);
    C = system.inverse();
  }
  if (!(used >= options.surface_min_points) || !all_finite(x) || !all_finite(C)) return false;
  *theta = x;
  *covariance = C;
  return true;
}

namespace detail {
// Is the surface beside a text the one that it is on? Then the surface, fitted without the text, goes through the
// text's centre and has its slant, as far as its points tell that. A sign that stands off its wall is likely to be
// turned, too.
TEXTPLANE_DEFERRED
bool lies_on(std::vector<SurfacePoint> points, const Vector3<Real>& centre, double length, const TextOptions& options,
             const TextObject& text) {
  points.erase(std::remove_if(points.begin(), points.end(), [](const SurfacePoint& p) { return !(p.beside > 0); }),
               points.end());
  Vector3<Real> theta = text.theta;
  const double distance = 1 / theta.norm();
  Matrix3<Real> covariance = text.covariance + guessed(theta, centre, radians(options.surface_most_turn),
                                                       options.surface_near * length / distance);
  if (!fit_to_surface(points, centre, options, &theta, &covariance)) return false;
  const double gap = std::abs(theta.dot(centre) - 1) / theta.norm();
  const double gap_sigma = std::sqrt(centre.dot(text.covariance * centre)) / theta.norm();
  const double turn = degrees_between(plane_normal(theta), plane_normal(text.theta));
  TextObject surface;
  surface.theta = theta;
  surface.covariance = covariance;
  const double turn_sigma =
      std::hypot(normal_sigma(text) / radians(1), normal_sigma(surface) / radians(1), options.surface_bend);
  return gap <= options.surface_gap * length + options.surface_sigmas * gap_sigma &&
         turn <= options.surface_sigmas * turn_sigma;
}
}  // namespace detail

/// The same for a text of a map, with the points beside it, if they show a surface that goes through its centre
/// (surface_gap) and has its slant (surface_sigmas). A sign that stands off its wall may be turned from it. A text that
/// hardly knows its own slant (surface_text_sigma) could not contradict a wrong surface, and stays as it was.
TEXTPLANE_DEFERRED
void fit_to_surface(const TextOptions& options, const PointLookup& points, const SE3d& T_w_h, TextObject& text) {
  const double sigma = normal_sigma(text);
  std::array<Vector3<Real>, 4> c;
  if (!(sigma <= detail::radians(options.surface_text_sigma)) || !is_ok(text_corners(text, &c))) return;
  const Vector3<Real> centre = plane_point(text.theta, text.patch.camera.unproject(centroid(text.patch.quad)));
  const double length = (std::max)((c[1] - c[0]).norm(), (c[3] - c[0]).norm());
  const std::vector<SurfacePoint> beside = points_beside(options, points, T_w_h, text);
  Vector3<Real> theta = text.theta;
  Matrix3<Real> covariance = text.covariance;
  if (!detail::lies_on(beside, centre, length, options, text) ||
      !fit_to_surface(beside, centre, options, &theta, &covariance))
    return;
  const double turn = detail::radians(detail::degrees_between(plane_normal(theta), plane_normal(text.theta)));
  if (turn > options.surface_sigmas * std::hypot(sigma, detail::radians(options.surface_bend))) return;
  text.theta = theta;
  text.covariance = covariance;
}

/// The same for a text without a plane, by the points alone. `seen`: in the host's frame, those that the host sees.
/// False, and nothing changed, with fewer than surface_min_points of them about the text, or where the normal stays
/// less certain than surface_max_sigma.
TEXTPLANE_DEFERRED
bool plane_from_surface(const TextOptions& options, const PointLookup& points, const SE3d& T_w_h,
                        const std::vector<Vector3<double>>& seen, TextObject& text) {
  const std::array<Vector2<Real>, 4>& c = text.patch.quad.corner;
  const Pinhole<Real>& camera = text.patch.camera;
  const Vector2<Real> middle = centroid(text.patch.quad);
  const double reach = (std::max)((c[1] - c[0]).norm(), (c[3] - c[0]).norm());
  std::vector<double> depths;
  for (const Vector3<Real>& p : seen)
    if (p.z() > 0 && (camera.project(p) - middle).norm() <= reach) depths.push_back(p.z());
  if (static_cast<double>(depths.size()) < options.surface_min_points) return false;

  // A guess: across the ray to the text, at the depth of what is seen there.
  const Vector3<Real> ray = camera.unproject(middle), centre = median(depths) * ray;
  TextObject guess = outline_of(text.patch, centre / centre.squaredNorm());
  guess.covariance = detail::guessed(guess.theta, centre, options.surface_guess_turn, options.surface_guess_depth);
  if (!fit_to_surface(points_beside(options, points, T_w_h, guess), centre, options, &guess.theta, &guess.covariance) ||
      !(normal_sigma(guess) <= detail::radians(options.surface_max_sigma)))
    return false;
  text.theta = guess.theta;
  text.covariance = guess.covariance;
  return true;
}

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_LANDMARKS_TEXT_SURFACE_HPP
