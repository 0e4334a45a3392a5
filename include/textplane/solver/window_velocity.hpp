// The velocities of a window's frames while their rows are taken, where they are unknowns: priors, and derivatives of
// points and texts by them.
#ifndef TEXTPLANE_SOLVER_WINDOW_VELOCITY_HPP
#define TEXTPLANE_SOLVER_WINDOW_VELOCITY_HPP

#include "textplane/solver/window_schur.hpp"

TEXTPLANE_BEGIN_NAMESPACE
namespace detail {

/// S is double, see BasicWindowSchur.
template <class S>
struct BasicWindowVelocities {
  using Matrix6 = FixedMatrix<S, 6, 6>;

  /// The priors: their cost at x,
  static double prior_cost(const Window& w, const WindowState& x, const BasicWindowStructure<S>& s) noexcept {
    double cost = 0;
    for (int f : s.frame_of_velocity)
      for (int i = 0; i < 6; ++i) {
        const S d = offset(w, x, f, i) / at(w.frames, f).velocity_sigma[i];
        cost += d * d;
      }
    return cost;
  }
  /// and the same, added to the sums.
  static void add_priors(const Window& w, const WindowState& x, const BasicWindowStructure<S>& s,
                         BasicWindowSchur<S>& out) noexcept {
    for (int f : s.frame_of_velocity)
      for (int i = 0; i < 6; ++i) {
        const S sigma = at(w.frames, f).velocity_sigma[i], information = 1 / (sigma * sigma);
        out.add_unknown(at(s.velocity_of_frame, f), i, information, information * offset(w, x, f, i));
      }
  }

  /// d px / d velocity, from d px / d p_c (J) of a point as its row sees it.
  static FixedMatrix<S, 2, 6> of_point(const FixedMatrix<S, 2, 3>& J, const Vector3<S>& p_c, const RowMotion& rows,
                                       S row) noexcept {
    FixedMatrix<S, 2, 6> by_pose;
    for (int r = 0; r < 2; ++r)
      for (int i = 0; i < 3; ++i) {
        const int j = i < 2 ? i + 1 : 0, k = i > 0 ? i - 1 : 2;
        by_pose(r, i) = J(r, i);
        by_pose(r, 3 + i) = p_c[j] * J(r, k) - p_c[k] * J(r, j);
      }
    return product(by_pose, velocity_jacobian(rows.velocity, rows.shutter.time(row)));
  }

  /// T_t_h between the time stamps.
  static SE3<S> relative_pose(const WindowText& t, const WindowTextObservation& k, const WindowState& x) noexcept {
    return at(x.T_w_c, k.frame).inverse() * at(x.T_w_c, t.host);
  }

  /// Normal equations of a text observation by the left increment xi of T_t_h and by theta, and Ad(T_t_h).
  struct TextSums {
    Matrix6 A, pose;
    FixedMatrix<S, 6, 3> cross;
    Vector6<S> g;
  };

  /// The velocities of host and target move the patch's centre, xi = Ad(T_t_h) V(-tau_h) d_h + Ad(E_t)^-1 V(tau_t) d_t
  /// with V of velocity_jacobian() and tau the centre's times; their action on its other rows is left to the cost.
  static void add_text(const Window& w, const WindowState& x, const BasicWindowStructure<S>& s, int k,
                       const TextSums& sums, BasicWindowSchur<S>& out) noexcept {
    const WindowTextObservation& ob = at(w.text_observations, k);
    const WindowText& t = at(w.texts, ob.text);
    const int of_host = at(s.velocity_of_frame, t.host), of_target = at(s.velocity_of_frame, ob.frame);
    const int host = at(s.camera_of_frame, t.host), target = at(s.camera_of_frame, ob.frame);
    const Vector3<S> m = t.patch->camera.unproject(centroid(t.patch->quad));
    const PatchRows& from = at(x.patch_rows, ob.text);
    Matrix6 F_host, F_target;
    if (of_host >= 0) {
      const S tau = from.time[0] * m[0] + from.time[1] * m[1] + from.time[2];
      F_host = product(sums.A, velocity_jacobian(from.velocity, -tau));
    }
    if (of_target >= 0) {
      const RowMotion& rows = at(x.rows, ob.frame);
      const Vector3<S>& theta = at(x.landmark, count(w.points) + ob.text);
      const S rho = theta[0] * m[0] + theta[1] * m[1] + theta[2];
      const RowProjection seen =
          project_rows(rows, w.camera, relative_pose(t, ob, x) * Vector3<S>(m[0] / rho, m[1] / rho, m[2] / rho));
      const S tau = is_ok(seen.status) ? rows.shutter.time(seen.px[1]) : S(0);
      F_target = product(adjoint(rows.after(-tau)), velocity_jacobian(rows.velocity, tau));
    }
    for (const bool is_host : {true, false}) {
      const int block = is_host ? of_host : of_target;
      if (block < 0) continue;
      const Matrix6& F = is_host ? F_host : F_target;
      const Matrix6 FH = transposed_product(F, sums.pose);
      out.add_camera(block, product(FH, F), transposed_product(F, sums.g));
      if (host >= 0) out.add_cameras(block, host, product(FH, sums.A));
      if (target >= 0) out.add_cameras(block, target, scaled(S(-1), FH));
      if (is_host && of_target >= 0) out.add_cameras(block, of_target, product(FH, F_target));
      const int slot = at(is_host ? s.host_velocity_slot : s.target_velocity_slot, k);
      if (slot >= 0) out.add_coupling(slot, transposed_product(F, sums.cross));
    }
  }

 private:
  static S offset(const Window& w, const WindowState& x, int f, int i) noexcept {
    return at(x.rows, f).velocity[i] - at(w.frames, f).rows->velocity[i];
  }
};

}  // namespace detail
TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_SOLVER_WINDOW_VELOCITY_HPP
