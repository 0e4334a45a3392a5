// Photometric residuals through rolling shutters: a request whose images take their rows one after the other becomes
// one of still images by the warp of geometry/row_warp.hpp, and what comes back is seen through it.
#ifndef TEXTPLANE_PHOTOMETRY_RESIDUAL_ROWS_HPP
#define TEXTPLANE_PHOTOMETRY_RESIDUAL_ROWS_HPP

#include <cmath>

#include "textplane/geometry/row_warp.hpp"
#include "textplane/photometry/residual_request.hpp"
#include "textplane/photometry/residual_result.hpp"

TEXTPLANE_BEGIN_NAMESPACE

namespace detail {

template <class T>
bool has_rows(const BasicPhotometricInput<T>& in) noexcept {
  return (in.rows && in.rows->active()) || (in.host_rows && in.host_rows->active());
}

// The ray of the middle of the patch.
template <class T>
Vector3<double> patch_centre(const BasicPhotometricInput<T>& in) noexcept {
  const PatchView& p = in.patch;
  const simd::PointBounds bounds =
      p.bounds.n == p.n || !p.x || !p.y || p.n < 1 ? p.bounds : simd::point_bounds(p.x, p.y, p.n);
  const Pinhole<double>& c = in.host_camera;
  return {(0.5 * (static_cast<double>(bounds.x_low) + static_cast<double>(bounds.x_high)) - c.cx) / c.fx,
          (0.5 * (static_cast<double>(bounds.y_low) + static_cast<double>(bounds.y_high)) - c.cy) / c.fy, 1};
}

// The same request of still images. Request: ResidualRequest or what derives from it.
template <class Request>
class RowForm {
 public:
  explicit RowForm(const Request& moving) noexcept : request_(moving) {
    auto& in = request_.input;
    // The target's camera of level 0, whose rows the motion counts.
    const double scale = std::ldexp(1.0, in.level);
    const Pinhole<double>& c = in.target_camera;
    const CameraView camera(
        Pinhole<double>(scale * c.fx, scale * c.fy, scale * (c.cx + 0.5) - 0.5, scale * (c.cy + 0.5) - 0.5), in.lens);
    warp_ = row_warp(moving.theta, moving.T_t_h, patch_centre(in), in.host_rows ? *in.host_rows : PatchRows(),
                     in.rows ? *in.rows : RowMotion(), camera);
    in.rows = nullptr;
    in.host_rows = nullptr;
    request_.theta = warp_.theta;
    request_.T_t_h = warp_.T_t_h;
  }

  const Request& request() const noexcept { return request_; }

  // Sums by the unknowns of the moving request from those of request(): H <- A^T H A, b <- A^T b.
  template <Parameters Unknowns>
  void pull_back(NormalEquations<dof(Unknowns)>* out) const noexcept {
    constexpr int P = dof(Unknowns);
    FixedMatrix<double, P, P> A;
    for (int c = 0; c < P; ++c)
      for (int r = 0; r < P; ++r) A(r, c) = entry<P>(r, c);
    out->H = transposed_product(A, product(out->H, A));
    const FixedMatrix<double, P, 1> b = out->b;
    out->b = transposed_product(A, b);
  }

  // One row of derivatives likewise: j <- j A.
  template <int P>
  void pull_back_row(double* row) const noexcept {
    double in[kLength<P>];
    for (int r = 0; r < P; ++r) in[r] = row[r];
    for (int c = 0; c < P; ++c) {
      row[c] = 0;
      for (int r = 0; r < P; ++r) row[c] += in[r] * entry<P>(r, c);
    }
  }

 private:
  // A: what RowWarp::pose and plane say.
  template <int P>
  double entry(int r, int c) const noexcept {
    constexpr int plane = P == 3 ? 0 : 6;  // the first row of theta
    if (r < plane && c < plane) return warp_.pose(r, c);
    return r >= plane && c >= plane ? warp_.plane(r - plane, c - plane) : 0;
  }

  Request request_;
  RowWarp warp_;
};

}  // namespace detail

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_PHOTOMETRY_RESIDUAL_ROWS_HPP
