// ResidualRequest: what the photometric residual is to be evaluated for. linearise(), evaluate() and residuals() take
// it.
#ifndef TEXTPLANE_PHOTOMETRY_RESIDUAL_REQUEST_HPP
#define TEXTPLANE_PHOTOMETRY_RESIDUAL_REQUEST_HPP

#include <cstdint>

#include "textplane/core/robust.hpp"
#include "textplane/core/se3.hpp"
#include "textplane/geometry/homography.hpp"
#include "textplane/photometry/photometric_input.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// The unknowns that derivatives are taken by.
enum class Parameters : std::uint8_t {
  pose,               ///< (v, omega): T_t_h <- Exp(xi) T_t_h, left; v in the unit of t, omega in rad.
  plane,              ///< theta, additively, in the inverse of that unit.
  pose_plane,         ///< (v, omega, theta).
  host_target_plane,  ///< (xi_h, xi_t, theta): both world poses, perturbed on ResidualRequest::side, and the plane.
};

/// How many unknowns there are.
constexpr int dof(Parameters parameters) noexcept {
  return parameters == Parameters::plane        ? 3
         : parameters == Parameters::pose       ? 6
         : parameters == Parameters::pose_plane ? 9
                                                : 15;
}

/// How derivatives treat the mean and the norm s of the target intensities.
enum class Normalisation : std::uint8_t {
  exact,   ///< Through both: dI~ = (1/s) (1 - 1 1^T / N - I~ I~^T) dI.
  frozen,  ///< Both held: dI~ = dI / s, as the published TextSLAM code does.
};

/// Settings of the photometric residual.
struct PhotometricOptions {
  Normalisation normalisation = Normalisation::exact;  ///< Of the derivatives.
  /// Acts on r sqrt(N), that is, delta is in units of 1/sqrt(N): on the difference of two patches of unit variance. The
  /// default 0.5 is 1.345 sigma (95 % efficiency) for the residuals of a match with ZNCC 0.93, since E = sigma^2 and
  /// ZNCC = 1 - E / 2.
  Robust robust{RobustKind::huber, 0.5};
  int min_visible = 15;  ///< The paper's minimum; fewer visible pixels are Status::too_few.
  /// Least population standard deviation of either side, in intensity units; at most 1e30.
  double min_contrast = 1.0;
  bool precise = false;  ///< All in double, by the slow reference, whatever the input.

  /// Whether the numbers make sense.
  bool valid() const noexcept { return robust.valid() && is_finite(min_contrast) && min_contrast <= 1e30; }
};

/// Whose gradients the derivatives use. The residual and its cost are the same for all; only J differs. With dq as the
/// parameters move q = H m~ (docs/equations.md):
///
///   forward            dI = a . dq,  a = dI_target/dq at the warped pixel
///   template_jacobian  dI = c . dq,  c = H^-T a_h,  a_h = dI_host/dm~: where the images match, I_target(H m~) and
///                      I_host(m~) have the same derivatives by m~, and m~ moves by H^-1 dq. Constant but for H^-1
///   esm                the mean of the two normalised rows, right to second order near the match
///   hybrid             b of forward; H = ratio H_template, H_template by the rows of template_jacobian over the whole
///                      patch, without weights; ratio = w (sum |J^T a_t|^2 / s_t^2) / (sum |a_h|^2 / s_h^2): the mean
///                      weight, and the energies of the gradients of target (visible pixels) and host (all pixels),
///                      a_t by the target's rays, J = d ray / d host pixel at the patch's centre
///
/// All vanish together at a perfect match. Elsewhere b of forward and hybrid alone is a gradient of the cost, so a
/// solver must judge the steps of the others by the cost. Ours do.
enum class LinearisePolicy : std::uint8_t {
  forward,            ///< Gradients of the target: the derivative of the cost itself.
  template_jacobian,  ///< Gradients of the host, prepared once: the cheapest iteration.
  esm,                ///< The mean of both: the widest basin.
  /// The exact gradient of the cost with the template's H: half the work of forward, and the same minimum. Needs
  /// `prepared`; without it, with a mask, and where no more than kHybridPixels are visible it is forward.
  hybrid,
  automatic,  ///< A coarse-to-fine solver chooses by level: see policy_at_level().
};

/// So few visible pixels are linearised by their own rows as fast as by what is prepared: hybrid is forward.
constexpr int kHybridPixels = 256;

/// What `automatic` means on a pyramid level: ESM on all levels but the finest, where hybrid (forward, where nothing is
/// prepared) ends at the minimum of the cost. The other policies are themselves on every level.
constexpr LinearisePolicy policy_at_level(LinearisePolicy policy, int level, int finest_level) noexcept {
  return policy != LinearisePolicy::automatic ? policy
         : level > finest_level               ? LinearisePolicy::esm
                                              : LinearisePolicy::hybrid;
}

class TemplatePatch;
template <class T>
struct PolicyRequest;

/// One patch in one target under one pose and plane; T is the pixel type of the target (std::uint8_t or float). An
/// aggregate: ResidualRequest{input, theta, T_t_h, options}. It refers to pixels and images, and owns the rest.
template <class T>
struct ResidualRequest {
  BasicPhotometricInput<T> input;                   ///< Patch, target and cameras.
  Vector3<double> theta = Vector3<double>::Zero();  ///< Plane in the host frame.
  SE3d T_t_h = {};                                  ///< Host to target; where rows move, between the time stamps.
  PhotometricOptions options = {};                  ///< Of every pixel.
  SE3d T_w_t = {};                                  ///< Target to world; see world_request().
  PerturbationSide side = PerturbationSide::right;  ///< Of both world poses; see world_request().

  /// The same request with derivatives by a policy, which linearise() of residual_policy.hpp takes. `prepared`, if
  /// given, is of input.patch; LinearisePolicy::template_jacobian is faster by it, and hybrid is forward without. It
  /// must outlive the request.
  PolicyRequest<T> by(LinearisePolicy policy, const TemplatePatch* prepared = nullptr) const noexcept {
    return {*this, policy, prepared};
  }
};
/// Deduces T from the input.
template <class T>
ResidualRequest(BasicPhotometricInput<T>, Vector3<double> = {}, SE3d = {}, PhotometricOptions = {})
    -> ResidualRequest<T>;

/// A request whose derivatives follow a policy. A type of its own, so that a program that never chooses one compiles
/// the forward kernels alone.
template <class T>
struct PolicyRequest : ResidualRequest<T> {
  LinearisePolicy policy = LinearisePolicy::forward;  ///< Whose gradients it takes.
  const TemplatePatch* prepared = nullptr;            ///< Of input.patch, or null.
};

/// The request for Parameters::host_target_plane: by the world poses (camera to world) of host and target. `side`: both
/// poses move by T_w_x <- Exp(xi_x) T_w_x (left) or T_w_x <- T_w_x Exp(xi_x) (right).
template <class T>
ResidualRequest<T> world_request(const BasicPhotometricInput<T>& input, const Vector3<double>& theta, const SE3d& T_w_h,
                                 const SE3d& T_w_t, PerturbationSide side,
                                 const PhotometricOptions& options = {}) noexcept {
  return {input, theta, T_w_t.inverse() * T_w_h, options, T_w_t, side};
}

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_PHOTOMETRY_RESIDUAL_REQUEST_HPP
