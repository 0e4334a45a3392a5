// A coarse search before a pose is refined: ZNCC of one text object under shifts and turns of its image, where the
// guess may be further off than the basin of refine_pose().
#ifndef TEXTPLANE_SOLVER_SEARCH_HPP
#define TEXTPLANE_SOLVER_SEARCH_HPP

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "textplane/photometry/candidates.hpp"
#include "textplane/photometry/patch.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// How far and how finely search_pose() looks, in px of the level it works on.
struct SearchOptions {
  int level = 2;      ///< Pyramid level; lowered to the coarsest that patch and target have with enough pixels.
  int radius = 4;     ///< Shifts -radius .. radius along x and along y, at most 8.
  double step = 1.0;  ///< Between shifts.
  /// Then the best is turned by this and half of it to both sides, rad, at half steps; 0: it is not.
  double roll = 0.1;
  PhotometricOptions photometric;  ///< Of every pixel.
};

namespace detail {

// Poses that turn a target camera about itself, tried row by row; the best is kept. Equals do not replace what was
// there.
TEXTPLANE_DEFERRED
class PoseSearch {
 public:
  static constexpr int kMost = 8;

  // `centre`: of the patch in the target, normalised.
  PoseSearch(const PhotometricInput& in, const Vector3<double>& theta, const SE3d& guess, const Vector2<double>& centre,
             const SearchOptions& options, PhotometricWorkspace& workspace, const TemplatePatch* prepared) noexcept
      : in_(in),
        theta_(theta),
        options_(options),
        workspace_(workspace),
        prepared_(prepared),
        centre_(centre),
        best_(guess) {
    try_row(guess, 0, 0, 0, 0, 0);
  }

  // Shifts of -radius .. radius steps of `from`, rolled about the ray of the centre before.
  void shifts(const SE3d& from, int radius, double step, double roll) noexcept {
    for (int y = -radius; y <= radius; ++y) try_row(from, -radius, radius, y, step, roll);
  }

  const SE3d& best() const noexcept { return best_; }
  float zncc() const noexcept { return zncc_; }

 private:
  void try_row(const SE3d& from, int first, int last, int y, double step, double roll) noexcept {
    SE3d row[2 * kMost + 1];
    float zncc[2 * kMost + 1];
    const double u = centre_[0], v = centre_[1], n = 1 + u * u + v * v, about = roll / std::sqrt(n);
    for (int x = first; x <= last; ++x) {
      // The rotation that takes the ray of the centre to the shifted one, to first order, and one about that ray.
      const double du = x * step / in_.target_camera.fx, dv = y * step / in_.target_camera.fy;
      Vector6<double> xi;
      xi << 0.0, 0.0, 0.0, -dv / n + about * u, du / n + about * v, (u * dv - v * du) / n + about;
      row[x - first] = se3_exp<double>(xi) * from;
    }
    const int count = last - first + 1;
    zncc_candidates(in_, theta_, row, count, options_.photometric, workspace_, zncc, prepared_);
    for (int i = 0; i < count; ++i) {
      if (!(zncc[i] > zncc_)) continue;
      zncc_ = zncc[i];
      best_ = row[i];
    }
  }

  const PhotometricInput& in_;
  const Vector3<double>& theta_;
  const SearchOptions& options_;
  PhotometricWorkspace& workspace_;
  const TemplatePatch* prepared_;
  Vector2<double> centre_;
  SE3d best_;
  float zncc_ = -1.0F;
};

}  // namespace detail

/// The level that search_pose() searches on in a target of `levels` levels: options.level, or the next finer one that
/// is there and has twice the pixels that must be visible; 0 where none has, -1 where there is no level.
inline int search_level(const TextPatch& patch, int levels, const SearchOptions& options) noexcept {
  int level = std::min({options.level, patch.level_count() - 1, levels - 1});
  while (level > 0 &&
         static_cast<int>(patch.levels[static_cast<std::size_t>(level)].x.size()) < 2 * options.photometric.min_visible)
    --level;
  return level;
}

/// The pose T_t_h, out of those that turn the target camera so that the patch's centre moves by the shifts of a grid,
/// with the best ZNCC of the patch in the target, and then turned a little about that centre where this is better
/// still; the guess itself where nothing is better or nothing can be compared. `zncc`, if given, receives the best
/// value, -1 where none. `prepared`: one TemplatePatch a level, or null. No allocation; `workspace` must have room for
/// the patch.
TEXTPLANE_DEFERRED
SE3d search_pose(const TextPatch& patch, const Vector3<double>& theta, const SE3d& T_t_h, const PyramidView& target,
                 const Pinhole<double>& camera, const SearchOptions& options, PhotometricWorkspace& workspace,
                 const TemplatePatch* prepared = nullptr, float* zncc = nullptr) noexcept {
  if (zncc) *zncc = -1.0F;
  const int level = search_level(patch, target.levels, options);
  if (level < 0 || !(options.step > 0) || !is_finite(options.step) || !is_finite(options.roll) || !camera.valid())
    return T_t_h;
  const PhotometricInput in = photometric_input(patch, level, target, camera);
  Vector3<double> q = Vector3<double>::Zero();
  for (const Vector2<double>& corner : patch.quad.corner) {
    const Vector3<double> m = patch.camera.unproject(corner);
    const double rho = theta.dot(m);
    for (int r = 0; r < 3; ++r)
      q[r] += 0.25 * (T_t_h.R(r, 0) * m[0] + T_t_h.R(r, 1) * m[1] + T_t_h.R(r, 2) * m[2] + rho * T_t_h.t[r]);
  }
  if (!(q[2] > 0)) return T_t_h;

  detail::PoseSearch<> search(in, theta, T_t_h, {q[0] / q[2], q[1] / q[2]}, options, workspace,
                              prepared ? prepared + level : nullptr);
  search.shifts(T_t_h, std::min(std::max(options.radius, 0), detail::PoseSearch<>::kMost), options.step, 0);
  if (options.roll != 0) {
    const SE3d shifted = search.best();
    for (const double share : {-1.0, -0.5, 0.0, 0.5, 1.0})
      search.shifts(shifted, 1, 0.5 * options.step, share * options.roll);
  }
  if (zncc) *zncc = search.zncc();
  return search.best();
}

TEXTPLANE_INSTANCE(SE3d search_pose<void>(const TextPatch&, const Vector3<double>&, const SE3d&, const PyramidView&,
                                          const Pinhole<double>&, const SearchOptions&, PhotometricWorkspace&,
                                          const TemplatePatch*, float*) noexcept);

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_SOLVER_SEARCH_HPP
