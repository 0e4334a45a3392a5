// A coarse search before a pose is refined: ZNCC of one text object under shifts of its image, where the guess may be further
// off than the basin of refine_pose().
#ifndef TEXTPLANE_SOLVER_SEARCH_HPP
#define TEXTPLANE_SOLVER_SEARCH_HPP

#include <algorithm>
#include <cstddef>

#include "textplane/photometry/candidates.hpp"
#include "textplane/photometry/patch.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// How far and how finely search_pose() looks, in px of the level it works on.
struct SearchOptions {
  int level = 2;      ///< Pyramid level; lowered to the coarsest that patch and target have with enough pixels.
  int radius = 4;     ///< Shifts -radius .. radius along x and along y, at most 8.
  double step = 1.0;  ///< Between shifts.
  PhotometricOptions photometric;
};

/// The pose T_t_h, out of those that turn the target camera so that the patch's centre moves by the shifts of a grid, with the
/// best ZNCC of the patch in the target; the guess itself where nothing is better or nothing can be compared. `zncc`, if given,
/// receives the best value, -1 where none. `prepared`: one TemplatePatch a level, or null. No allocation; `workspace` must have
/// room for the patch.
template <class = void>  // instantiated where it is called: including the header costs little
SE3d search_pose(const TextPatch& patch, const Vector3<double>& theta, const SE3d& T_t_h,
                        const PyramidView& target, const Pinhole<double>& camera, const SearchOptions& options,
                        PhotometricWorkspace& workspace, const TemplatePatch* prepared = nullptr,
                        float* zncc = nullptr) noexcept {
  constexpr int kMost = 8, kRow = 2 * kMost + 1;
  if (zncc) *zncc = -1.0F;
  int level = std::min({options.level, patch.level_count() - 1, target.levels - 1});
  while (level > 0 &&
         static_cast<int>(patch.levels[static_cast<std::size_t>(level)].x.size()) < 2 * options.photometric.min_visible)
    --level;
  if (level < 0 || !(options.step > 0) || !camera.valid()) return T_t_h;
  const PhotometricInput in = photometric_input(patch, level, target, camera);
  const Pinhole<double> c = camera.at_level(level);
  Vector3<double> q = Vector3<double>::Zero();
  for (const Vector2<double>& corner : patch.quad.corner) {
    const Vector3<double> m = patch.camera.unproject(corner);
    const double rho = theta.dot(m);
    for (int r = 0; r < 3; ++r)
      q[r] += 0.25 * (T_t_h.R(r, 0) * m[0] + T_t_h.R(r, 1) * m[1] + T_t_h.R(r, 2) * m[2] + rho * T_t_h.t[r]);
  }
  if (!(q[2] > 0)) return T_t_h;
  const double u = q[0] / q[2], v = q[1] / q[2];

  const int radius = std::min(std::max(options.radius, 0), kMost), side = 2 * radius + 1;
  SE3d row[kRow], best = T_t_h;
  float value[kRow], best_value = -1.0F;
  for (int y = -radius; y <= radius; ++y) {
    for (int x = -radius; x <= radius; ++x) {
      // The rotation about the camera that takes the ray of the centre to the shifted one, to first order.
      const double du = x * options.step / c.fx, dv = y * options.step / c.fy, n = 1 + u * u + v * v;
      const Vector3<double> from(u, v, 1), to(u + du, v + dv, 1);
      const Vector3<double> omega = from.cross(to) / n;
      Vector6<double> xi;
      xi << 0.0, 0.0, 0.0, omega[0], omega[1], omega[2];
      row[x + radius] = se3_exp<double>(xi) * T_t_h;
    }
    zncc_candidates(in, theta, row, side, options.photometric, workspace, value, prepared ? prepared + level : nullptr);
    for (int i = 0; i < side; ++i) {
      // Equals do not replace the guess.
      const bool centre = y == 0 && i == radius;
      if (value[i] > best_value || (centre && !(value[i] < best_value) && value[i] > -1.0F)) {
        best_value = value[i];
        best = row[i];
      }
    }
  }
  if (zncc) *zncc = best_value;
  return best_value > -1.0F ? best : T_t_h;
}

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_SOLVER_SEARCH_HPP
