// The terms of a window's cost, reprojection errors of points (window_points.hpp) and photometric errors of texts:
// derivatives by poses and landmarks, and values at a trial state.
#ifndef TEXTPLANE_SOLVER_WINDOW_TERMS_HPP
#define TEXTPLANE_SOLVER_WINDOW_TERMS_HPP

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "textplane/solver/window_points.hpp"
#include "textplane/solver/window_schur.hpp"

TEXTPLANE_BEGIN_NAMESPACE
namespace detail {

/// Cost of a trial on the pixels that the last linearisation saw.
struct WindowTrial {
  double cost = 0;
  double lost_fraction = 0;
  bool possible = false;  ///< False where a point went behind a camera or the cost is not finite.
};

/// S is double, see BasicWindowSchur.
template <class S>
class BasicWindowTerms {
 public:
  /// Resets the out fields, marks unusable elements, linearises the texts. Allocates for the largest window so far.
  void prepare(Window& w, const WindowOptions& o, const WindowState& x) {
    path_ = Path::kernel;
    for (WindowFrame& f : w.frames) f.status = Status::ok;
    for (WindowPoint& p : w.points) p.status = all_finite(p.p_w) ? Status::ok : Status::non_finite;
    for (WindowPointObservation& k : w.point_observations) {
      Vector3<S> p_c;
      k.chi2 = 0;
      k.status = !all_finite(k.px) || !is_finite(k.sigma)     ? Status::non_finite
                 : !valid_sigma(k.sigma)                      ? Status::invalid_argument
                 : at(w.points, k.point).status != Status::ok ? Status::too_few
                 : Points::in_front(w, k, x, o, &p_c)         ? Status::ok
                                                              : Status::behind_camera;
    }
    int longest = 0;
    for (WindowText& t : w.texts) {
      t.covariance.setZero();
      t.information.setZero();
      t.zncc = 0;
      t.used_observations = 0;
      t.status = !all_finite(t.theta)                                              ? Status::non_finite
                 : !t.patch || !is_ok(t.patch->status) || !t.patch->camera.valid() ? Status::invalid_argument
                                                                                   : Status::ok;
      if (t.status == Status::ok) longest = (std::max)(longest, t.patch->max_pixels());
    }
    photometric_.reserve(longest);
    mask_begin_.assign(w.text_observations.size() + 1, 0);
    for (std::size_t k = 0; k < w.text_observations.size(); ++k) {
      WindowTextObservation& ob = w.text_observations[k];
      const WindowText& t = at(w.texts, ob.text);
      ob.zncc = 0;
      ob.visible = 0;
      ob.status = t.status != Status::ok  ? Status::too_few
                  : ob.frame == t.host    ? Status::degenerate
                  : !is_finite(ob.weight) ? Status::non_finite
                  : !(ob.weight > 0)      ? Status::invalid_argument
                  : w.calibration         ? Status::invalid_argument
                                          : Status::ok;
      mask_begin_[k + 1] =
          mask_begin_[k] + (ob.status == Status::ok ? static_cast<std::size_t>(t.patch->max_pixels()) : 0);
    }
    mask_.resize(mask_begin_.back());
    text_.resize(w.text_observations.size());
    for (int k = 0; k < count(w.text_observations); ++k)
      if (at(w.text_observations, k).status == Status::ok)
        at(w.text_observations, k).status = linearise_text(w, o, x, k);
  }

  /// Linearises the active texts at x. Those that fail are left out from now on, with their status.
  void linearise_texts(Window& w, const WindowOptions& o, const WindowState& x, BasicWindowStructure<S>& s) {
    for (int k = 0; k < count(s.text_active); ++k) {
      if (!at(s.text_active, k)) continue;
      at(w.text_observations, k).status = linearise_text(w, o, x, k);
      if (at(w.text_observations, k).status != Status::ok) at(s.text_active, k) = 0;
    }
  }

  /// Sums all terms at x, texts as last linearised. Returns the cost.
  double accumulate(const Window& w, const WindowOptions& o, const WindowState& x, const BasicWindowStructure<S>& s,
                    BasicWindowSchur<S>& out) const {
    out.begin(s);
    double cost = Points::add_priors(w, x, s, out);
    for (int k = 0; k < count(s.point_active); ++k)
      if (at(s.point_active, k)) cost += Points::add(w, o, x, s, k, out);
    for (int k = 0; k < count(s.text_active); ++k)
      if (at(s.text_active, k)) cost += add_text(w, o, x, s, k, out);
    if (s.scale_a >= 0) {
      const SE3<S>&a = at(x.T_w_c, s.scale_a), &b = at(x.T_w_c, s.scale_b);
      const Vector3<S> u = (b.t - a.t).normalized();
      out.set_scale_row(at(s.camera_of_frame, s.scale_a), -transposed_product(a.R, u), at(s.camera_of_frame, s.scale_b),
                        transposed_product(b.R, u));
    }
    return cost;
  }

  /// Cost of the trial y. A point that goes behind a camera returns to its position in x, so that it does not spoil the
  /// step of all others.
  WindowTrial evaluate(const Window& w, const WindowOptions& o, const WindowState& x, const BasicWindowStructure<S>& s,
                       WindowState& y) {
    WindowTrial trial;
    if (!y.camera_possible) return trial;
    bool taken_back = true;
    for (int pass = 0; taken_back; ++pass) {
      taken_back = false;
      trial.cost = Points::prior_cost(w, y, s);
      for (int k = 0; k < count(s.point_active); ++k) {
        if (!at(s.point_active, k)) continue;
        const WindowPointObservation& ob = at(w.point_observations, k);
        Vector3<S> p_c;
        if (Points::in_front(w, ob, y, o, &p_c)) {
          trial.cost += o.point_robust.rho(Points::chi2(w, ob, y, p_c));
        } else {
          if (pass > 0) return trial;
          at(y.landmark, ob.point) = at(x.landmark, ob.point);
          taken_back = true;
        }
      }
    }
    int lost = 0, pixels = 0;
    for (int k = 0; k < count(s.text_active); ++k) {
      if (!at(s.text_active, k)) continue;
      const WindowTextObservation& ob = at(w.text_observations, k);
      const int visible = at(text_, k).visible;
      const PhotometricCost c = textplane::evaluate(request(w, o, y, ob), photometric_, mask(k));
      path_ = (std::max)(path_, c.path);
      pixels += visible;
      lost += is_ok(c.status) ? c.lost : visible;
      trial.cost += weight(o, ob, visible) * (is_ok(c.status) ? c.cost : o.photometric.robust.rho(2.0));
    }
    trial.lost_fraction = pixels > 0 ? static_cast<double>(lost) / pixels : 0;
    trial.possible = is_finite(trial.cost);
    return trial;
  }

  /// Writes chi2, zncc and visible counts of all observations at x, texts as last linearised.
  void report(Window& w, const WindowOptions& o, const WindowState& x, const BasicWindowStructure<S>& s) {
    for (WindowPointObservation& k : w.point_observations) {
      Vector3<S> p_c;
      const bool usable = k.status != Status::non_finite && k.status != Status::invalid_argument;
      const bool front = usable && Points::in_front(w, k, x, o, &p_c);
      constexpr double kMost = (std::numeric_limits<double>::max)();
      k.chi2 = front ? (std::min)(Points::chi2(w, k, x, p_c), kMost) : kMost;
      if (k.status == Status::ok && !front) k.status = Status::behind_camera;
    }
    for (int k = 0; k < count(s.text_active); ++k) {
      if (!at(s.text_active, k)) continue;
      WindowTextObservation& ob = at(w.text_observations, k);
      WindowText& t = at(w.texts, ob.text);
      ob.zncc = at(text_, k).zncc;
      ob.visible = at(text_, k).visible;
      t.zncc += ob.zncc;
      ++t.used_observations;
    }
    for (WindowText& t : w.texts)
      if (t.used_observations > 0) t.zncc /= t.used_observations;
  }

  Path path() const noexcept { return path_; }  ///< What computed the texts since prepare().

  /// Mean depth of the active observations, the unit of length for step_tolerance.
  double mean_depth(const Window& w, const WindowOptions& o, const WindowState& x,
                    const BasicWindowStructure<S>& s) const {
    double sum = 0;
    int n = 0;
    for (int k = 0; k < count(s.point_active); ++k) {
      Vector3<S> p_c;
      if (!at(s.point_active, k) || !Points::in_front(w, at(w.point_observations, k), x, o, &p_c)) continue;
      sum += p_c[2];
      ++n;
    }
    for (int k = 0; k < count(s.text_active); ++k) {
      if (!at(s.text_active, k)) continue;
      const Vector3<S>& theta = at(x.landmark, count(w.points) + at(w.text_observations, k).text);
      sum += 1 / theta.norm();
      ++n;
    }
    return n > 0 ? sum / n : 1;
  }

 private:
  using Points = BasicWindowPoints<S>;
  using Velocities = BasicWindowVelocities<S>;
  using Matrix6 = typename BasicWindowSchur<S>::Matrix6;
  using Matrix63 = typename BasicWindowSchur<S>::Matrix63;

  static SE3<S> relative_pose(const WindowText& t, const WindowTextObservation& k, const WindowState& x) noexcept {
    return Velocities::relative_pose(t, k, x);
  }
  static double weight(const WindowOptions& o, const WindowTextObservation& k, int visible) noexcept {
    return k.weight * text_weight(o.weighting, o.sigma_rep, o.sigma_photo, visible);
  }
  const std::uint8_t* mask(int k) const noexcept { return mask_.data() + at(mask_begin_, k); }

  static ResidualRequest<std::uint8_t> request(const Window& w, const WindowOptions& o, const WindowState& x,
                                               const WindowTextObservation& k) noexcept {
    const WindowText& t = at(w.texts, k.text);
    const WindowFrame& f = at(w.frames, k.frame);
    CameraView camera = camera_of(w, k.frame);
    camera.rows = f.rows ? &at(x.rows, k.frame) : nullptr;
    PhotometricInput input = photometric_input(*t.patch, o.text_level, f.image, camera, k.scale_shift);
    input.host_rows = &at(x.patch_rows, k.text);
    return {input, at(x.landmark, count(w.points) + k.text), relative_pose(t, k, x), o.photometric};
  }

  Status linearise_text(const Window& w, const WindowOptions& o, const WindowState& x, int k) noexcept {
    const WindowTextObservation& ob = at(w.text_observations, k);
    NormalEquations<9>& out = at(text_, k);
    const ResidualRequest<std::uint8_t> q = request(w, o, x, ob);
    out = textplane::linearise<Parameters::pose_plane>(q, photometric_);
    path_ = (std::max)(path_, out.path);
    if (is_ok(out.status))
      std::copy_n(photometric_.visible(), q.input.patch.n,
                  mask_.begin() + static_cast<std::ptrdiff_t>(at(mask_begin_, k)));
    return out.status;
  }

  // From xi of T_t_h (left) to the world poses: d xi / d xi_host = Ad(T_t_h), d xi / d xi_target = -1, and on to the
  // bases where they are cameras of rigs. Two cameras of one rig have no motion between them.
  double add_text(const Window& w, const WindowOptions& o, const WindowState& x, const BasicWindowStructure<S>& s,
                  int k, BasicWindowSchur<S>& out) const noexcept {
    const WindowTextObservation& ob = at(w.text_observations, k);
    const WindowText& t = at(w.texts, ob.text);
    const NormalEquations<9>& ne = at(text_, k);
    const FixedMatrix<S, 9, 9>& H = ne.H;
    const Eigen::Matrix<S, 9, 1>& b = ne.b;
    const S scale = weight(o, ob, ne.visible);
    const int landmark = count(w.points) + ob.text;
    const int host = at(s.camera_of_frame, t.host), target = at(s.camera_of_frame, ob.frame);
    Matrix6 A = adjoint(relative_pose(t, ob, x));
    Matrix6 pose = scaled(scale, block<6, 6>(H, 0, 0));
    Vector6<S> g = scaled(scale, block<6, 1>(b, 0, 0));
    Matrix63 cross = scaled(scale, block<6, 3>(H, 0, 6));
    if (at(s.landmark_free, landmark))
      out.add_landmark(landmark, scaled(scale, block<3, 3>(H, 6, 6)), scaled(scale, block<3, 1>(b, 6, 0)));
    if (host >= 0 && host == target) return scale * ne.cost;
    if (at(w.frames, t.host).base >= 0) A = product(A, base_jacobian(at(w.frames, t.host)));
    const Matrix6 host_pose = transposed_product(A, pose);
    const WindowFrame& seen = at(w.frames, ob.frame);
    if (host >= 0) out.add_camera(host, product(host_pose, A), transposed_product(A, g));
    if (at(s.host_slot, k) >= 0) out.add_coupling(at(s.host_slot, k), transposed_product(A, cross));
    Matrix6 between = host_pose;
    if (seen.base >= 0) {
      const Matrix6 B = base_jacobian(seen);
      pose = transposed_product(B, product(pose, B));
      g = transposed_product(B, g);
      cross = transposed_product(B, cross);
      between = product(host_pose, B);
    }
    if (target >= 0) out.add_camera(target, pose, scaled(S(-1), g));
    if (host >= 0 && target >= 0) out.add_cameras(host, target, scaled(S(-1), between));
    if (at(s.target_slot, k) >= 0) out.add_coupling(at(s.target_slot, k), scaled(S(-1), cross));
    if (!s.frame_of_velocity.empty()) Velocities::add_text(w, x, s, k, {A, pose, cross, g}, out);
    return scale * ne.cost;
  }

  PhotometricWorkspace photometric_;
  Path path_ = Path::kernel;
  std::vector<NormalEquations<9>> text_;
  std::vector<std::uint8_t> mask_;
  std::vector<std::size_t> mask_begin_;
};

using WindowTerms = BasicWindowTerms<double>;

}  // namespace detail
TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_SOLVER_WINDOW_TERMS_HPP
