// The reprojection errors of a window: values, and derivatives by poses, points and the camera's parameters.
#ifndef TEXTPLANE_SOLVER_WINDOW_POINTS_HPP
#define TEXTPLANE_SOLVER_WINDOW_POINTS_HPP

#include "textplane/solver/window_velocity.hpp"

TEXTPLANE_BEGIN_NAMESPACE
namespace detail {

/// S is double, see BasicWindowSchur.
template <class S>
struct BasicWindowPoints {
  /// p_c = T_w_c^-1 p_w at the state x, as the row of the observation sees it. Whether the camera sees it.
  static bool in_front(const Window& w, const WindowPointObservation& k, const WindowState& x, const WindowOptions& o,
                       Vector3<S>* p_c) noexcept {
    const SE3<S>& T = at(x.T_w_c, k.frame);
    const Vector3<S>& p_w = at(x.landmark, k.point);
    const S d0 = p_w[0] - T.t[0], d1 = p_w[1] - T.t[1], d2 = p_w[2] - T.t[2];
    for (int i = 0; i < 3; ++i) (*p_c)[i] = T.R(0, i) * d0 + T.R(1, i) * d1 + T.R(2, i) * d2;
    if (at(w.frames, k.frame).rows) *p_c = at(x.rows, k.frame).at(k.px[1]) * *p_c;
    if (!((*p_c)[2] > o.min_depth) || !all_finite(*p_c)) return false;
    return w.calibration ? x.camera.in_domain(*p_c) : camera_of(w, k.frame).in_domain(*p_c);
  }

  /// |e|^2 / sigma^2 of a point that the camera sees.
  static double chi2(const Window& w, const WindowPointObservation& k, const WindowState& x,
                     const Vector3<S>& p_c) noexcept {
    const Vector2<S> px = w.calibration ? x.camera.project(p_c) : camera_of(w, k.frame).project(p_c);
    return (px - k.px).squaredNorm() / (k.sigma * k.sigma);
  }

  /// Adds observation k to the sums, and returns its cost. d p_c = -v + [p_c]x omega for T_w_c <- T_w_c Exp(v, omega),
  /// and R_w_c^T d p_w.
  static double add(const Window& w, const WindowOptions& o, const WindowState& x, const BasicWindowStructure<S>& s,
                    int k, BasicWindowSchur<S>& out) noexcept {
    const WindowPointObservation& ob = at(w.point_observations, k);
    Vector3<S> p_c;
    in_front(w, ob, x, o, &p_c);
    FixedMatrix<S, 2, 3> J;
    typename AnyCamera<S>::ParameterJacobian J_parameters;
    const Vector2<S> e =
        (w.calibration ? x.camera.project(p_c, &J, &J_parameters) : camera_of(w, ob.frame).project(p_c, &J)) - ob.px;
    const double information = 1 / (ob.sigma * ob.sigma), r2 = e.squaredNorm() * information;
    const double weight = o.point_robust.weight(r2) * information;
    const int velocity = at(s.velocity_of_frame, ob.frame);
    FixedMatrix<S, 2, 6> J_velocity;
    if (at(w.frames, ob.frame).rows) {
      const RowMotion& rows = at(x.rows, ob.frame);
      if (velocity >= 0) J_velocity = Velocities::of_point(J, p_c, rows, ob.px[1]);
      // p_c = E p with p at the time stamp: J by p, and p itself.
      const SE3<S> E = rows.at(ob.px[1]);
      J = product(J, E.R);
      p_c = E.inverse() * p_c;
    }
    const int camera = at(s.camera_of_frame, ob.frame), slot = at(s.point_slot, k);
    const bool free = at(s.landmark_free, ob.point) != 0;
    FixedMatrix<S, 2, 6> J_camera, weighted_camera;
    FixedMatrix<S, 2, 3> J_point;
    if (camera >= 0) {
      for (int r = 0; r < 2; ++r) {
        for (int c = 0; c < 3; ++c) J_camera(r, c) = -J(r, c);
        J_camera(r, 3) = J(r, 1) * p_c[2] - J(r, 2) * p_c[1];
        J_camera(r, 4) = J(r, 2) * p_c[0] - J(r, 0) * p_c[2];
        J_camera(r, 5) = J(r, 0) * p_c[1] - J(r, 1) * p_c[0];
      }
      const WindowFrame& frame = at(w.frames, ob.frame);
      if (frame.base >= 0) J_camera = product(J_camera, base_jacobian(frame));
      weighted_camera = scaled(weight, J_camera);
      out.add_camera(camera, weighted_camera, J_camera, e);
    }
    if (free) {
      const Matrix3<S>& R = at(x.T_w_c, ob.frame).R;
      for (int c = 0; c < 3; ++c)
        for (int r = 0; r < 2; ++r) J_point(r, c) = J(r, 0) * R(c, 0) + J(r, 1) * R(c, 1) + J(r, 2) * R(c, 2);
      out.add_landmark(ob.point, scaled(weight, J_point), J_point, e);
    }
    if (slot >= 0) out.add_coupling(slot, weighted_camera, J_point);
    if (velocity >= 0) {
      const FixedMatrix<S, 2, 6> weighted_velocity = scaled(weight, J_velocity);
      out.add_camera(velocity, weighted_velocity, J_velocity, e);
      out.add_cameras(velocity, camera, weighted_velocity, J_camera);
      if (free) out.add_coupling(at(s.point_velocity_slot, k), weighted_velocity, J_point);
    }
    if (s.calibration.blocks() > 0)
      add_parameters(s, ob, {weight, J_parameters, J_camera, J_velocity, J_point, e}, out);
    return o.point_robust.rho(r2);
  }

  /// The priors of the camera's parameters and of velocities: their cost at x,
  static double prior_cost(const Window& w, const WindowState& x, const BasicWindowStructure<S>& s) noexcept {
    double cost = 0;
    for (int i = 0; i < s.calibration.count(); ++i) {
      const S d = s.calibration.offset(i, x.camera.parameters());
      cost += s.calibration.information(i) * d * d;
    }
    return cost + Velocities::prior_cost(w, x, s);
  }
  /// and the same, added to the sums. Unknowns that pad a block stay zero.
  static double add_priors(const Window& w, const WindowState& x, const BasicWindowStructure<S>& s,
                           BasicWindowSchur<S>& out) noexcept {
    const typename AnyCamera<S>::Parameters p = x.camera.parameters();
    for (int i = 0; i < 6 * s.calibration.blocks(); ++i) {
      const bool used = i < s.calibration.count();
      const S information = used ? s.calibration.information(i) : S(1);
      out.add_unknown(s.parameter_block() + i / 6, i % 6, information,
                      used ? information * s.calibration.offset(i, p) : S(0));
    }
    Velocities::add_priors(w, x, s, out);
    return prior_cost(w, x, s);
  }

 private:
  using Velocities = BasicWindowVelocities<S>;

  // Of one observation; what has no block means nothing.
  struct Derivatives {
    S weight;
    const typename AnyCamera<S>::ParameterJacobian& J_parameters;
    const FixedMatrix<S, 2, 6>&J_camera, &J_velocity;
    const FixedMatrix<S, 2, 3>& J_point;
    const Vector2<S>& e;
  };
  // The part of the camera's parameters.
  static void add_parameters(const BasicWindowStructure<S>& s, const WindowPointObservation& ob, const Derivatives& d,
                             BasicWindowSchur<S>& out) noexcept {
    const int camera = at(s.camera_of_frame, ob.frame), velocity = at(s.velocity_of_frame, ob.frame);
    for (int b = 0; b < s.calibration.blocks(); ++b) {
      const int block = s.parameter_block() + b;
      const FixedMatrix<S, 2, 6> J_b = s.calibration.template columns<S>(d.J_parameters, b);
      const FixedMatrix<S, 2, 6> weighted_b = scaled(d.weight, J_b);
      out.add_camera(block, weighted_b, J_b, d.e);
      if (camera >= 0) out.add_cameras(block, camera, weighted_b, d.J_camera);
      if (velocity >= 0) out.add_cameras(block, velocity, weighted_b, d.J_velocity);
      for (int a = 0; a < b; ++a)
        out.add_cameras(block, s.parameter_block() + a, weighted_b,
                        s.calibration.template columns<S>(d.J_parameters, a));
      if (at(s.landmark_free, ob.point)) out.add_coupling(s.calibration_slot(ob.point, b), weighted_b, d.J_point);
    }
  }
};

}  // namespace detail
TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_SOLVER_WINDOW_POINTS_HPP
