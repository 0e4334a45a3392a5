// The normal equations of pose and plane, seen through the world poses of host and target.
#ifndef TEXTPLANE_PHOTOMETRY_WORLD_PARAMETERS_HPP
#define TEXTPLANE_PHOTOMETRY_WORLD_PARAMETERS_HPP

#include <cstdint>

#include "textplane/photometry/residual_request.hpp"
#include "textplane/photometry/residual_result.hpp"

TEXTPLANE_BEGIN_NAMESPACE

namespace detail {
inline double dot3(const double* p, const double* q) noexcept { return p[0] * q[0] + p[1] * q[1] + p[2] * q[2]; }

// The sums by (v, omega, theta) of T_t_h, seen through d xi(T_t_h) / d (xi_h, xi_t): relative_pose_jacobians(), without
// products by its zeros. The target's factor is -I, or the negative of the host's, so H has rank 9 at most.
// (S is double, Relative 9, World 15: a template, so that including the header costs little.)
template <class S, int Relative, int World>
void world_sums(const NormalEquations<Relative>& inner, const SE3<S>& T, bool right,
                NormalEquations<World>* out) noexcept {
  const Matrix3<S> upper = product(hat(T.t), T.R);
  // Of the adjoint: columns 0 to 2 are (R_k, 0), columns 3 to 5 are (X_k, R_k). W is its transpose times the pose's
  // rows.
  const S *R = T.R.data(), *X = upper.data(), *H = inner.H.data(), *b = inner.b.data();
  double W[6][9], *to = out->H.data();
  for (int i = 0; i < 3; ++i) {
    for (int c = 0; c < 9; ++c) {
      W[i][c] = dot3(R + 3 * i, H + 9 * c);
      W[3 + i][c] = dot3(X + 3 * i, H + 9 * c) + dot3(R + 3 * i, H + 9 * c + 3);
    }
    out->b[i] = dot3(R + 3 * i, b);
    out->b[3 + i] = dot3(X + 3 * i, b) + dot3(R + 3 * i, b + 3);
    out->b[12 + i] = b[6 + i];
  }
  for (int i = 0; i < 6; ++i) {
    out->b[6 + i] = right ? -b[i] : -out->b[i];
    for (int j = 0; j <= i; ++j)
      to[15 * i + j] = to[15 * j + i] =
          j < 3 ? dot3(W[i], R + 3 * j) : dot3(W[i], X + 3 * j - 9) + dot3(W[i] + 3, R + 3 * j - 9);
  }
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) {
      to[15 * i + 6 + j] = to[15 * (6 + j) + i] = right ? -W[i][j] : -to[15 * i + j];
      to[15 * (6 + i) + 6 + j] = right ? H[9 * i + j] : to[15 * i + j];
    }
  for (int k = 0; k < 3; ++k) {
    for (int i = 0; i < 6; ++i) {
      to[15 * i + 12 + k] = to[15 * (12 + k) + i] = W[i][6 + k];
      to[15 * (6 + i) + 12 + k] = to[15 * (12 + k) + 6 + i] = right ? -H[9 * i + 6 + k] : -W[i][6 + k];
    }
    for (int l = 0; l < 3; ++l) to[15 * (12 + l) + 12 + k] = H[9 * (6 + l) + 6 + k];
  }
}

// Parameters::host_target_plane of Parameters::pose_plane. H and b mean nothing unless is_ok(out->status).
template <class T, int Relative, int World>
void world_parameters(const NormalEquations<Relative>& inner, const ResidualRequest<T>& request,
                      NormalEquations<World>* out) noexcept {
  out->status = inner.status;
  out->path = inner.path;
  if (!is_ok(inner.status)) return;
  const bool right = request.side == PerturbationSide::right;
  world_sums(inner, right ? request.T_t_h : request.T_w_t.inverse(), right, out);
  std::uint64_t bad = 0;
  for (int i = 0; i < 225; ++i) bad |= not_finite_bit(out->H.data()[i]);
  for (int i = 0; i < 15; ++i) bad |= not_finite_bit(out->b[i]);
  if (bad >> 63 != 0)
    out->status = Status::non_finite;
  else
    static_cast<ResidualStats&>(*out) = inner;
}
}  // namespace detail

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_PHOTOMETRY_WORLD_PARAMETERS_HPP
