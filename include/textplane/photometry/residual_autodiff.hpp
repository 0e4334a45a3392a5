// The photometric residual for any scalar: the definition that dual numbers differentiate, with no derivative written
// out.
#ifndef TEXTPLANE_PHOTOMETRY_RESIDUAL_AUTODIFF_HPP
#define TEXTPLANE_PHOTOMETRY_RESIDUAL_AUTODIFF_HPP

#include <cmath>
#include <cstdint>

#include "textplane/core/se3.hpp"
#include "textplane/photometry/photometric_input.hpp"
#include "textplane/photometry/sample.hpp"
#include "textplane/photometry/zncc.hpp"

TEXTPLANE_BEGIN_NAMESPACE

namespace reference {

/// Residuals r_i = I~_host - I~_target over exactly the pixels of `on_set` (a byte a pixel; usually workspace.visible()
/// of residuals()), as functions of theta and T_t_h of scalar type S: double, a dual number, ceres::Jet. The image is
/// sampled with the gradient of the bilinear interpolant. r receives patch.n numbers, zero outside the set.
///
/// `frozen`: mean and s to hold for the target (Normalisation::frozen); null: they are functions of the parameters too
/// (Normalisation::exact).
///
/// Status::behind_camera or out_of_view where a pixel of the set is not visible, too_few or no_contrast as
/// intensity_stats() says, invalid_argument for null pointers or an image that is not valid(); r then holds no
/// residuals. No allocation.
template <class S, class T>
Status residuals_t(const BasicPhotometricInput<T>& in, const Vector3<S>& theta, const SE3<S>& T_t_h,
                   const std::uint8_t* on_set, const IntensityStats* frozen, S* r) noexcept {
  using std::sqrt;
  const PatchView& p = in.patch;
  if (!p.x || !p.y || !p.intensity || p.n < 0 || !on_set || !r || !in.target.valid()) return Status::invalid_argument;
  const IntensityStats host = intensity_stats(p.intensity, on_set, p.n);
  if (!is_ok(host.status)) return host.status;

  // r holds the target intensities until their mean and norm are known.
  S sum(0);
  for (int i = 0; i < p.n; ++i) {
    r[i] = S(0);
    if (!on_set[i]) continue;
    const Vector2<double> px(static_cast<double>(p.x[i]), static_cast<double>(p.y[i]));
    const Vector3<S> m = in.host_camera.unproject(px).template cast<S>();
    const S rho = theta[0] * m[0] + theta[1] * m[1] + theta[2];
    const Vector3<S> q = T_t_h.R * m + T_t_h.t * rho;
    if (!(rho > S(0)) || !(q[2] > S(0))) return Status::behind_camera;
    Vector2<S> m_d(q[0] / q[2], q[1] / q[2]);
    if (in.lens) {
      if (!(m_d[0] * m_d[0] + m_d[1] * m_d[1] <= S(in.lens->max_r2()))) return Status::out_of_view;
      m_d = in.lens->distort_as(m_d);
    }
    const S x = S(in.target_camera.fx) * m_d[0] + S(in.target_camera.cx);
    const S y = S(in.target_camera.fy) * m_d[1] + S(in.target_camera.cy);
    if (!sample_bilinear(in.target, x, y, &r[i])) return Status::out_of_view;
    sum = sum + r[i];
  }

  S mean, s;
  if (frozen) {
    mean = S(frozen->mean);
    s = S(frozen->s);
  } else {
    mean = sum / S(host.n);
    S squares(0);
    for (int i = 0; i < p.n; ++i)
      if (on_set[i]) squares = squares + (r[i] - mean) * (r[i] - mean);
    if (!(squares > S(0))) return Status::no_contrast;
    s = sqrt(squares);
  }
  for (int i = 0; i < p.n; ++i) {
    if (!on_set[i]) continue;
    const double reference_value = (static_cast<double>(p.intensity[i]) - host.mean) / host.s;
    r[i] = S(reference_value) - (r[i] - mean) / s;
  }
  return Status::ok;
}

}  // namespace reference

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_PHOTOMETRY_RESIDUAL_AUTODIFF_HPP
