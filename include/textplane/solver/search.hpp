// A coarse search for guesses outside the basin of refine_pose(): ZNCC of one text object under shifts and rotations.
#ifndef TEXTPLANE_SOLVER_SEARCH_HPP
#define TEXTPLANE_SOLVER_SEARCH_HPP

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "textplane/photometry/candidates.hpp"
#include "textplane/photometry/patch.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// Range and resolution of search_pose(), in px of its level.
struct SearchOptions {
  int level = 2;      ///< Pyramid level; search_level() may lower it.
  int radius = 4;     ///< Shifts -radius .. radius along x and along y, at most 8.
  double step = 1.0;  ///< Between shifts.
  /// rad: then rotates the best by this and half of it to both sides, at half steps; 0: does not.
  double roll = 0.1;
  PhotometricOptions photometric;  ///< Of every pixel.
};

namespace detail {

// Tries rotations of the target camera about its centre, row by row, and keeps the first best one.
TEXTPLANE_DEFERRED
class PoseSearch {
 public:
  static constexpr int kMost = 8;

  // `centre`: of the patch in the target, normalised coordinates.
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

  // Shifts of -radius .. radius steps from `from`, after a roll about the ray of the centre.
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
      // The rotation of the centre's ray to the shifted one, to first order, and the roll about that ray.
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

/// The level that search_pose() searches in a target of `levels` levels: the coarsest, up to options.level, that patch
/// and target have and that holds at least 2 min_visible pixels. 0 where none does, -1 where there is no level.
inline int search_level(const TextPatch& patch, int levels, const SearchOptions& options) noexcept {
  int level = (std::min)({options.level, patch.level_count() - 1, levels - 1});
  const auto pixels = [&patch](int l) { return static_cast<int>(patch.levels[static_cast<std::size_t>(l)].x.size()); };
  while (level > 0 && pixels(level) / 2 < options.photometric.min_visible) --level;  // twice that may be no int
  return level;
}

/// The pose T_t_h with the best ZNCC among rotations of the target camera from the guess `T_t_h`. They shift the
/// patch's centre over a grid, then roll about it. Returns the guess where none is better. `zncc`, unless null,
/// receives the best value, -1 where nothing can be compared. `prepared`: one TemplatePatch a level, or null. No
/// allocation; `workspace` must have room for the patch.
TEXTPLANE_DEFERRED
SE3d search_pose(const TextPatch& patch, const Vector3<double>& theta, const SE3d& T_t_h, const PyramidView& target,
                 const CameraView& camera, const SearchOptions& options, PhotometricWorkspace& workspace,
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
  search.shifts(T_t_h, (std::min)((std::max)(options.radius, 0), detail::PoseSearch<>::kMost), options.step, 0);
  if (options.roll != 0) {
    const SE3d shifted = search.best();
    for (const double share : {-1.0, -0.5, 0.0, 0.5, 1.0})
      search.shifts(shifted, 1, 0.5 * options.step, share * options.roll);
  }
  if (zncc) *zncc = search.zncc();
  return search.best();
}

TEXTPLANE_INSTANCE(SE3d search_pose<>(const TextPatch&, const Vector3<double>&, const SE3d&, const PyramidView&,
                                      const CameraView&, const SearchOptions&, PhotometricWorkspace&,
                                      const TemplatePatch*, float*) noexcept);

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_SOLVER_SEARCH_HPP
