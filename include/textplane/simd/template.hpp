// Template kernels: one warp, value-only sampling, and the exact sums of the sampled values with constant rows, for
// template-Jacobian iterations and for correlation. photometry/template_patch.hpp is the typed form.
//
// Host pixels come as coordinates (u, v) relative to the patch's centre, and in blocks of kTemplateBlock pixels with a
// column of int16 for each factor: the host's intensity, and the eight derivatives j of it by a homography in host
// coordinates. The target's value at a pixel is interpolated in fixed point,
//
//   V = 64 (I - 127.5),   I the bilinear interpolant at a position rounded to 2^-15 px,
//
// within 0.025 grey levels of the interpolant at the float position (2^-16 px times the gradient, and two roundings of
// 1/128 each). All sums are exact integers of these V; so up to the float warp the results are the same on every
// target.
//
// The columns are rounded too (to 1/8191 of their largest entry, or finer). The fixed point of the iteration stays:
// the projections through mean and norm use the sums of the rounded columns, so a target that equals the host but for
// gain and bias has a gradient of exactly zero. Rounding changes H and b by its own relative size. Cauchy's and Tukey's
// costs sum float rows with their weights; there that gradient is zero but for rounding.
#ifndef TEXTPLANE_SIMD_TEMPLATE_HPP
#define TEXTPLANE_SIMD_TEMPLATE_HPP

#include <cstddef>
#include <cstdint>

#include "textplane/simd/esm.hpp"

TEXTPLANE_BEGIN_NAMESPACE

namespace simd {

/// Pixels of a block: n is rounded up to a multiple of it, and all arrays below hold that many, the int16 columns zero
/// and the others anything finite beyond n.
constexpr int kTemplateBlock = 32;
/// int16 columns of a block: the host's intensity, then the eight derivatives. |entry| <= 8191.
constexpr int kTemplateColumns = 9;

/// Arguments of the sums. Nothing is checked, but whatever the positions, no byte outside the image's rows is read.
struct TemplateArgs {
  const float* u = nullptr;
  const float* v = nullptr;
  const std::int16_t* rows = nullptr;  ///< Blocks of kTemplateColumns x kTemplateBlock.
  int n = 0;
  Image8 target;  ///< readable(); its pairs are used where it has them.
  /// x = (g[0] u + g[1] v + g[2]) / w + ox, y = (g[3] u + g[4] v + g[5]) / w + oy, w = g[6] u + g[7] v + 1, with ox and
  /// oy such that x - ox and y - oy lie in [0, 65535]. All (x, y) lie inside [0, width - 1) x [0, height - 1), and all
  /// w > 0.
  float g[8] = {1, 0, 0, 0, 1, 0, 0, 0};
  int ox = 0, oy = 0;
  std::int16_t* values = nullptr;  ///< Receives V, zero beyond n. May not overlap anything.
};

/// Sums over the n pixels.
struct TemplateSums {
  std::int64_t column[kTemplateColumns];  ///< Of column times V.
  std::int64_t value, square;             ///< Of V and V^2.
};

/// What is prepared of a host patch, once. j = step times the derivative columns; h = (column 0 - mean) / norm.
struct TemplateModel {
  const float* u = nullptr;
  const float* v = nullptr;
  const std::int16_t* rows = nullptr;
  const float* intensity = nullptr;  ///< Column 0.
  const float* gx = nullptr;         ///< Gradients, intensity units a px.
  const float* gy = nullptr;
  int n = 0;
  PointBounds bounds;   ///< Of the host pixels; u and v are relative to its middle.
  double mean = 0;      ///< Of column 0.
  double norm = 0;      ///< ||column 0 - mean||.
  double s = 0;         ///< The same in intensity units.
  double step[8] = {};  ///< Intensity units of 1 in a derivative column.
  double e[8] = {};     ///< sum j / n.
  double c[8] = {};     ///< sum h j.
  double S[8][8] = {};  ///< sum j j^T.
  /// Without weights, for a homography in host coordinates: (S - n e e^T - c c^T) / s^2, and S / s^2.
  double H_exact[8][8] = {}, H_frozen[8][8] = {};
};

}  // namespace simd

TEXTPLANE_END_NAMESPACE

#define TEXTPLANE_SIMD_KERNEL "textplane/simd/kernels/residual/template_cells.inl"
#include "textplane/simd/foreach_target.inl"
#define TEXTPLANE_SIMD_KERNEL "textplane/simd/kernels/residual/template.inl"
#include "textplane/simd/foreach_target.inl"
#define TEXTPLANE_SIMD_KERNEL "textplane/simd/kernels/residual/template_model.inl"
#include "textplane/simd/foreach_target.inl"

TEXTPLANE_BEGIN_NAMESPACE

namespace detail {
TEXTPLANE_KERNEL void linearise_template(const simd::TemplateModel& m, const simd::ResidualArgs& args,
                                         std::int16_t* values, simd::ResidualInfo* out, double* H, double* b) noexcept
    TEXTPLANE_SIMD_BODY(linearise_template(m, args, values, out, H, b));
TEXTPLANE_KERNEL void evaluate_template(const simd::TemplateModel& m, const simd::ResidualArgs& args,
                                        std::int16_t* values, simd::ResidualInfo* out) noexcept
    TEXTPLANE_SIMD_BODY(evaluate_template(m, args, values, out));
}  // namespace detail

namespace simd {

/// V of every pixel, and all sums.
TEXTPLANE_KERNEL void template_sums(const TemplateArgs& args, TemplateSums& sums) noexcept
    TEXTPLANE_SIMD_BODY(template_sums(args, sums));

/// V of every pixel, and the sums of the first column, of V and of V^2: what a correlation needs. The others are zero.
TEXTPLANE_KERNEL void template_correlation(const TemplateArgs& args, TemplateSums& sums) noexcept
    TEXTPLANE_SIMD_BODY(template_correlation(args, sums));

/// Template-Jacobian normal equations for (v, omega, theta), P = 9. Of `args` the host's pixels are not read (n must be
/// the model's), masks neither: all pixels count, and where not all of them are visible the status is unsupported, and
/// another kernel must take the case. `values`: room for n int16, rounded up to blocks. Otherwise as
/// linearise_pose_plane().
inline ResidualInfo linearise_template(const TemplateModel& model, const ResidualArgs& args, std::int16_t* values,
                                       double* H, double* b) noexcept {
  ResidualInfo out;
  detail::linearise_template(model, args, values, &out, H, b);
  return out;
}

/// Cost, E and counts alone, on the same terms. Without Huber this is the correlation: ZNCC = 1 - E / 2.
inline ResidualInfo evaluate_template(const TemplateModel& model, const ResidualArgs& args,
                                      std::int16_t* values) noexcept {
  ResidualInfo out;
  detail::evaluate_template(model, args, values, &out);
  return out;
}

}  // namespace simd

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_SIMD_TEMPLATE_HPP
