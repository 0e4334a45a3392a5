// The pose of a frame by mapped texts and the host's points together, as far as either knows it.
//
// A text's plane is not exact, so it is an unknown beside the pose, held by its covariance:
//
//   C(T, theta_i) = sum_points rho(|e|^2 / (sigma s)^2)
//                 + sum_texts N / (v_i sigma_i^2) c_i(T, theta_i) + |theta_i - theta_i0|^2 by Sigma_i^-1
//
// c_i is the robust photometric cost (residual.hpp), sigma_i^2 = 2 (1 - ZNCC) what the text differs by in this very
// image, v_i its variance factor (TextObject). Each theta_i is eliminated by the Schur complement, so a plane that is
// hardly known says little, and in no direction more than it knows. s is the scale of the points' residuals.
//
// A text may be wrong by more than its covariance says: it moved, or its key frames drifted. Its terms (H_i, b_i) and
// those of all the rest (H_r, b_r) have minima of their own, which differ by
//
//   d = H_i^-1 b_i - H_r^-1 b_r     chi2 = d^T (H_i^-1 + H_r^-1)^-1 d
//
// as both are taken at one pose. chi2 has as many degrees of freedom as the text determines of the pose.
//
// Points that nobody adjusts drift together, and their residuals do not show it. The texts do: with d between all texts
// and all points, the covariance of the points is f times what their residuals say,
//
//   d^T (C_texts + f C_points)^-1 d = degrees of freedom, f >= 1
#ifndef TEXTPLANE_LANDMARKS_TEXT_POSE_HPP
#define TEXTPLANE_LANDMARKS_TEXT_POSE_HPP

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "textplane/core/order.hpp"
#include "textplane/landmarks/text_plane.hpp"
#include "textplane/landmarks/text_view.hpp"
#include "textplane/photometry/residual.hpp"
#include "textplane/solver/pose.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// A mapped text that a frame may show.
struct FrameText {
  const TextObject* object = nullptr;  ///< With a plane.
  SE3d T_w_h;                          ///< Of its host.
  int scale_shift = 0;                 ///< Of photometric_input().
  bool used = false;                   ///< Whether it takes part.
  double trust = 1;                    ///< Factor of its weight.
  double zncc = 0;                     ///< Result: at the pose found.
  double share = 0;                    ///< Result: of the information on the camera's position, 0 to 1.
};

/// The standard deviation of a residual of a text that an image shows with this ZNCC, in units of 1/sqrt(N). Views err
/// as wholes, by resampling too: no ZNCC counts for more than .985.
TEXTPLANE_DEFERRED
inline double text_sigma(const TextObject& text, double zncc) noexcept {
  return std::sqrt(text.variance_factor * (std::max)(2 * (1 - zncc), 0.03));
}

/// Solves for the pose of one frame; keeps its memory. For one thread at a time.
TEXTPLANE_DEFERRED
class BasicTextPose {
 public:
  static constexpr std::size_t kFewestPoints = 8;  ///< Fewer have no scale.

  /// Scale of the points' residuals about a pose, in units of their sigmas: the median of |e| / sigma over that of a
  /// Rayleigh distribution, at least `least`. 1 for fewer than kFewestPoints.
  double point_scale(const std::vector<PosePointTerm>& points, const CameraView& camera, const SE3d& T_c_w,
                     double least) {
    errors_.clear();
    for (const PosePointTerm& point : points) {
      Vector3<Real> p;
      Vector2<Real> e;
      const SE3d row = detail::row_increment(point, camera);
      if (detail::reproject(point, T_c_w, camera, camera.rows ? &row : nullptr, &p, &e))
        errors_.push_back(e.norm() / point.sigma);
    }
    if (errors_.size() < kFewestPoints) return 1;
    return (std::max)(least, sigma_of_lengths(errors_));
  }

  /// Sets every text's zncc at a pose, at level 0; -1 where it cannot be compared there. Returns the least.
  double judge(std::vector<FrameText>& texts, const TextImage& image, const SE3d& T_c_w) {
    double least = 1;
    for (FrameText& text : texts) {
      const auto cost = compare_text(*text.object, 0, image, T_c_w * text.T_w_h, text.scale_shift, photometric_);
      text.zncc = is_ok(cost.status) ? cost.zncc : -1;
      least = (std::min)(least, text.zncc);
    }
    return least;
  }

  /// Iterates from *T_c_w over the texts that are `used`, at level 0, until a step is a hundredth of a standard
  /// deviation. False where the terms do not determine the pose.
  bool solve(const std::vector<PosePointTerm>& points, double scale, std::vector<FrameText>& texts,
             const TextImage& image, SE3d* T_c_w, int iterations = 8) {
    theta_.resize(texts.size());
    for (std::size_t i = 0; i < texts.size(); ++i) theta_[i] = texts[i].object->theta;
    for (const FrameText& text : texts) photometric_.reserve(text.object->patch.max_pixels());
    eliminated_.resize(texts.size());
    for (int k = 0; k < iterations; ++k) {
      detail::PoseSystem system;
      for (PosePointTerm point : points) {
        point.sigma *= scale;
        const SE3d row = detail::row_increment(point, image.camera);
        detail::add_point(point, *T_c_w, image.camera, image.camera.rows ? &row : nullptr, robust_, system);
      }
      detail::mirror(system);
      for (std::size_t i = 0; i < texts.size(); ++i) add_text(texts[i], i, image, *T_c_w, system);
      const Ldlt<Real, 6> factors(system.H, 1e-12);
      if (!factors.ok()) return false;
      const Vector6<Real> step = -factors.solve(system.b);
      if (!all_finite(step)) return false;
      *T_c_w = renormalised(se3_exp<double>(step) * *T_c_w);
      for (std::size_t i = 0; i < texts.size(); ++i)
        if (eliminated_[i].in)
          theta_[i] -= eliminated_[i].C_inverse * (eliminated_[i].h + eliminated_[i].B.transpose() * step);
      information_ = system.H;
      if (-step.dot(system.b) < kStep * kStep) break;
    }
    const double all = information_.template topLeftCorner<3, 3>().trace();
    for (FrameText& text : texts) text.share = all > 0 ? text.share / all : 0;
    return true;
  }

  /// Of the last solve: inverse of the covariance of the pose, xi left.
  const FixedMatrix<Real, 6, 6>& information() const noexcept { return information_; }

  /// Weighs the texts anew by how much each disagrees with all the rest after the last solve, r = sqrt(chi2 / degrees
  /// of freedom): trust min(1, huber / r), and the worst one with r > most leaves. True where that asks for another
  /// solve.
  bool weigh(std::vector<FrameText>& texts, double huber, double most) {
    bool changed = false;
    FrameText* worst = nullptr;
    double largest = most;
    huber = (std::max)(huber, 0.0);
    for (std::size_t i = 0; i < texts.size(); ++i) {
      const double r = disagreement(eliminated_[i], texts[i].trust);
      const double trust = r > huber ? huber / r : 1;
      changed |= std::abs(trust - texts[i].trust) > kTrust;
      texts[i].trust = trust;
      if (r <= largest) continue;
      largest = r;
      worst = &texts[i];
    }
    if (worst) worst->used = false;
    return changed || worst;
  }

  /// f of the points, at most 256, after a solve that took their covariances as `f_taken` times what their residuals
  /// say. Each text is left out in turn and the least f counts, so no text alone makes the points doubtful. 0 where
  /// fewer than two texts take part, or where either side does not determine the pose.
  double point_doubt(const std::vector<FrameText>& texts, double f_taken) const noexcept {
    FixedMatrix<Real, 6, 6> H = FixedMatrix<Real, 6, 6>::Zero();
    Vector6<Real> b = Vector6<Real>::Zero();
    int count = 0;
    for (std::size_t i = 0; i < texts.size(); ++i) {
      if (!eliminated_[i].in) continue;
      ++count;
      H += texts[i].trust * eliminated_[i].H;
      b += texts[i].trust * eliminated_[i].b;
    }
    if (count < 2) return 0;
    const FixedMatrix<Real, 6, 6> points = f_taken * (information_ - H);
    FixedMatrix<Real, 6, 6> covariance;
    if (!invert(points, 1e-12, &covariance)) return 0;
    double least = kMostDoubt;
    for (std::size_t i = 0; i < texts.size(); ++i) {
      const Eliminated& text = eliminated_[i];
      if (!text.in) continue;
      const Apart apart(H - texts[i].trust * text.H, b - texts[i].trust * text.b, points, covariance, -f_taken * b);
      if (!apart.ok) return 0;
      if (apart.freedom < kLeastFreedom) return 1;      // this one says nothing
      if (apart.chi2(least) > apart.freedom) continue;  // this one asks for more
      double f = 1;
      while (f < least && apart.chi2(f) > apart.freedom) f *= kDoubtStep;
      if (f == 1) return 1;  // no other asks for less
      least = (std::min)(least, f);
    }
    return least;
  }

 private:
  struct Eliminated {
    bool in = false;
    FixedMatrix<Real, 6, 6> H;  // of the pose, after the plane is eliminated; weight included, trust not
    Vector6<Real> b;
    FixedMatrix<Real, 6, 3> B;
    Matrix3<Real> C_inverse;
    Vector3<Real> h;
  };

  static constexpr double kStep = 0.01;                         // standard deviations
  static constexpr double kTrust = 0.05;                        // a smaller change of trust is none
  static constexpr double kMostDoubt = 256, kDoubtStep = 1.25;  // of f
  static constexpr double kLeastFreedom = 0.5;                  // of chi2; a text with less says nothing
  static constexpr double kWeak = 1e-3;  // a direction of which a text knows less than this share is not its own

  static bool invert(const FixedMatrix<Real, 6, 6>& H, double least_pivot, FixedMatrix<Real, 6, 6>* inverse) noexcept {
    const Ldlt<Real, 6> factors(H, least_pivot);
    if (factors.ok()) *inverse = factors.inverse();
    return factors.ok();
  }

  // Two sets of terms by the minima that each has alone.
  struct Apart {
    FixedMatrix<Real, 6, 6> own_covariance, others_covariance;
    Vector6<Real> d;
    double freedom = 0;
    bool ok = false;

    // `covariance` is the inverse of H_others.
    Apart(const FixedMatrix<Real, 6, 6>& H, const Vector6<Real>& b, const FixedMatrix<Real, 6, 6>& H_others,
          const FixedMatrix<Real, 6, 6>& covariance, const Vector6<Real>& b_others) noexcept
        : others_covariance(covariance) {
      if (!invert(H + kWeak * H_others, 1e-14, &own_covariance)) return;
      d = own_covariance * b - others_covariance * b_others;
      // The trace of the product, as both are symmetric.
      freedom = 6 - kWeak * H_others.cwiseProduct(own_covariance).sum();
      ok = true;
    }

    // With the covariance of the others as `factor` times what their terms say; 0 where it cannot be told.
    double chi2(double factor) const noexcept {
      const Ldlt<Real, 6> both(FixedMatrix<Real, 6, 6>(own_covariance + factor * others_covariance), 1e-14);
      return both.ok() ? d.dot(both.solve(d)) : 0;
    }
  };

  // r of weigh(); 0 where the rest does not determine the pose.
  double disagreement(const Eliminated& text, double trust) const noexcept {
    if (!text.in) return 0;
    // All terms sum up to b = 0: that of the rest is -trust b_i.
    const FixedMatrix<Real, 6, 6> rest = information_ - trust * text.H;
    FixedMatrix<Real, 6, 6> covariance;
    if (!invert(rest, 1e-12, &covariance)) return 0;
    const Apart apart(text.H, text.b, rest, covariance, -trust * text.b);
    if (!apart.ok) return 0;
    const double chi2 = apart.chi2(1);
    return chi2 > 0 && apart.freedom > kLeastFreedom ? std::sqrt(chi2 / apart.freedom) : 0;
  }

  void add_text(FrameText& text, std::size_t i, const TextImage& image, const SE3d& T_c_w, detail::PoseSystem& system) {
    Eliminated& out = eliminated_[i];
    out.in = false;
    text.share = 0;
    if (!text.used) return;
    const TextObject& object = *text.object;
    const auto input = photometric_input(object.patch, 0, image.pyramid, image.camera, text.scale_shift);
    const auto n =
        linearise<Parameters::pose_plane>(ResidualRequest{input, theta_[i], T_c_w * text.T_w_h}, photometric_);
    text.zncc = is_ok(n.status) ? n.zncc : -1;
    const Ldlt<Real, 3> prior(object.covariance, 1e-12);
    if (!is_ok(n.status) || !prior.ok()) return;
    const double weight = text_weight(Weighting::variance, 1, text_sigma(object, n.zncc), n.visible);
    const Matrix3<Real> known = prior.inverse();
    const FixedMatrix<Real, 6, 6> A = weight * n.H.template topLeftCorner<6, 6>();
    out.B = weight * n.H.template topRightCorner<6, 3>();
    const Matrix3<Real> C = Matrix3<Real>(weight * n.H.template bottomRightCorner<3, 3>()) + known;
    const Ldlt<Real, 3> plane(C, 1e-14);
    if (!plane.ok()) return;
    out.C_inverse = plane.inverse();
    out.h = weight * n.b.template tail<3>() + known * (theta_[i] - object.theta);
    out.in = true;
    const FixedMatrix<Real, 6, 3> K = out.B * out.C_inverse;
    out.H = A - K * out.B.transpose();
    out.b = weight * n.b.template head<6>() - K * out.h;
    system.H += text.trust * out.H;
    system.b += text.trust * out.b;
    text.share = text.trust * out.H.template topLeftCorner<3, 3>().trace();
  }

  std::vector<double> errors_;
  std::vector<Vector3<Real>> theta_;
  std::vector<Eliminated> eliminated_;
  PhotometricWorkspace photometric_;
  FixedMatrix<Real, 6, 6> information_ = FixedMatrix<Real, 6, 6>::Zero();
  Robust robust_ = PoseOptions{}.point_robust;
};
using TextPose = BasicTextPose<>;  ///< It is compiled only where it is used.

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_LANDMARKS_TEXT_POSE_HPP
