// What the photometric kernels take and give: inputs, options, sums and the scratch memory.
#ifndef TEXTPLANE_PHOTOMETRY_RESIDUAL_TYPES_HPP
#define TEXTPLANE_PHOTOMETRY_RESIDUAL_TYPES_HPP

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <vector>

#include "textplane/core/cameras/pinhole.hpp"
#include "textplane/core/image_view.hpp"
#include "textplane/core/numeric.hpp"
#include "textplane/core/status.hpp"
#include "textplane/photometry/patch.hpp"
#include "textplane/photometry/prepared_target.hpp"
#include "textplane/photometry/pyramid.hpp"
#include "textplane/photometry/robust.hpp"
#include "textplane/simd/residual.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// How derivatives treat the mean and the norm s of the target intensities.
enum class Normalisation : std::uint8_t {
  exact,   ///< Through both: dI~ = (1/s) (1 - 1 1^T / N - I~ I~^T) dI.
  frozen,  ///< Both held: dI~ = dI / s, as the published TextSLAM code does.
};

/// Settings of the photometric residual.
struct PhotometricOptions {
  /// Of the derivatives.
  Normalisation normalisation = Normalisation::exact;
  /// Acts on r sqrt(N), that is, delta is in units of 1/sqrt(N): on the difference of two patches of unit variance. The
  /// default 0.5 is 1.345 sigma (95 % efficiency) for the residuals of a match with ZNCC 0.93, since E = sigma^2 and
  /// ZNCC = 1 - E / 2.
  Robust robust{RobustKind::huber, 0.5};
  int min_visible = 15;       ///< The paper's minimum; fewer visible pixels are Status::too_few.
  double min_contrast = 1.0;  ///< Least population standard deviation of either side, in intensity units.
  bool precise = false;       ///< All in double, by the reference, whatever the input: slow.

  /// Whether the numbers make sense.
  bool valid() const noexcept { return robust.valid() && is_finite(min_contrast); }
};

/// One host patch seen in one target image, T being the pixel type of the target. All three are of one pyramid level: the
/// cameras are Pinhole::at_level() of it.
template <class T>
struct BasicPhotometricInput {
  static_assert(std::is_same<T, std::uint8_t>::value || std::is_same<T, float>::value,
                "textplane: target images are 8-bit or float; T is the pixel's type without const");

  /// Host pixels of one level.
  PatchView patch;
  Pinhole<double> host_camera;    ///< Of the level that `patch` is of.
  Pinhole<double> target_camera;  ///< Of the level that `target` is.
  /// Image of one level.
  ImageView<const T> target;
  PairView pairs = {};  ///< Of an 8-bit target, optional: PreparedTarget. Must be of the same image.
};
using PhotometricInput = BasicPhotometricInput<std::uint8_t>;  ///< Of an 8-bit target.
using PhotometricInputF = BasicPhotometricInput<float>;        ///< Of a float target.

namespace detail {
struct Unset {};

// photometric_input() for PyramidView and anything like it.
template <class View>
auto level_input(const TextPatch& patch, int level, const View& target, const Pinhole<double>& target_camera,
                 int scale_shift) noexcept {
  using Pixel = std::remove_const_t<typename std::decay_t<decltype(target.level[0])>::Pixel>;
  BasicPhotometricInput<Pixel> in;
  if (level < 0 || level >= kMaxPyramidLevels || scale_shift < -kMaxPyramidLevels || scale_shift > kMaxPyramidLevels)
    return in;
  const int host_level = scale_shift < 0 ? level - scale_shift : level;
  const int target_level = scale_shift > 0 ? level + scale_shift : level;
  if (host_level >= patch.level_count() || target_level >= target.levels || target_level >= kMaxPyramidLevels)
    return in;
  in.patch = patch.levels[static_cast<std::size_t>(host_level)].view();
  in.host_camera = patch.camera.at_level(host_level);
  in.target_camera = target_camera.at_level(target_level);
  in.target = target.level[static_cast<std::size_t>(target_level)];
  return in;
}
}  // namespace detail

/// The input of pyramid level `level`; `target_camera` is that of level 0.
///
/// `scale_shift` s pairs levels of one scale where host and target see the object at different sizes: with s > 0 the target's
/// level is `level` + s, with s < 0 the host's is `level` - s. Neither side is then sampled more coarsely than its pixels,
/// which would alias. See scale_shift(). A level that patch or target lacks gives an input that every kernel answers with
/// Status::invalid_argument.
inline PhotometricInput photometric_input(const TextPatch& patch, int level, const PyramidView& target,
                                          const Pinhole<double>& target_camera, int scale_shift = 0) noexcept {
  return detail::level_input(patch, level, target, target_camera, scale_shift);
}

/// The shift of photometric_input() for an object of these areas (px^2, level 0) in host and target: the difference of their
/// scales in octaves, rounded, at most `limit` either way. 0 for areas that are not positive and finite.
inline int scale_shift(double host_area, double target_area, int limit = 1) noexcept {
  if (!(host_area > 0) || !(target_area > 0) || !is_finite(host_area) || !is_finite(target_area)) return 0;
  const double octaves = std::round(0.5 * std::log2(target_area / host_area));
  return octaves > limit ? limit : octaves < -limit ? -limit : static_cast<int>(octaves);
}

namespace detail {
// E of a sum of squares: what rounding adds does not lead out of [0, 4].
inline double range_error(double sum) noexcept { return sum < 0.0 ? 0.0 : sum > 4.0 ? 4.0 : sum; }
}  // namespace detail

/// Sums over the visible pixels for P parameters: with residuals r = I~_host - I~_target, their derivatives J (N x P), and
/// the robust weights W, H = J^T W J and b = J^T W r. The Gauss-Newton step is -H^-1 b. All zero unless is_ok(status).
template <int P>
struct NormalEquations {
  /// J^T W J.
  Eigen::Matrix<double, P, P> H;
  /// J^T W r.
  Eigen::Matrix<double, P, 1> b;
  double cost = 0.0;   ///< Sum of rho(N r^2) / N.
  double error = 0.0;  ///< E = sum of r^2, in [0, 4].
  double zncc = 0.0;   ///< 1 - E / 2, in [-1, 1].
  int visible = 0;     ///< N.
  double mean = 0.0;   ///< Of the target intensities of the visible pixels.
  double s = 0.0;      ///< ||I - mean|| of the same.
  /// Whether the sums can be used.
  Status status = Status::invalid_argument;

  NormalEquations() noexcept { clear(); }
  /// H and b are left as they are in memory: for who fills them at once. Zeroing both takes as long as some kernels.
  explicit NormalEquations(detail::Unset) noexcept {}
  /// H and b become zero.
  void clear() noexcept {
    H.setZero();
    b.setZero();
  }
};

/// Value of the photometric cost. All zero unless is_ok(status), `visible` and `lost` excepted.
struct PhotometricCost {
  double cost = 0.0;   ///< Sum of rho(N r^2) / N over the visible pixels, plus the charge for the lost ones.
  double error = 0.0;  ///< E = sum of r^2 over the visible pixels, in [0, 4].
  double zncc = 0.0;   ///< 1 - E / 2, in [-1, 1].
  int visible = 0;     ///< N.
  int lost = 0;        ///< Pixels of the given set that are not visible now.
  /// Whether the cost can be used.
  Status status = Status::invalid_argument;
};

/// What residuals() found out besides the residuals.
struct ResidualSummary {
  int visible = 0;    ///< N.
  double mean = 0.0;  ///< Of the target intensities of the visible pixels.
  double s = 0.0;     ///< ||I - mean|| of the same.
  /// Whether the residuals can be used.
  Status status = Status::invalid_argument;
};

/// Scratch memory of the photometric kernels: one for each thread, for any number of calls.
class PhotometricWorkspace {
 public:
  PhotometricWorkspace() = default;
  /// With room for n pixels.
  explicit PhotometricWorkspace(int n) { reserve(n); }

  /// Makes room for patches of n pixels: 89 bytes a pixel and some. The only member that allocates; never shrinks.
  void reserve(int n) {
    if (n <= capacity()) return;
    const auto size = static_cast<std::size_t>(n);
    const std::size_t doubles = size * (2 + kMaxRow) * sizeof(double);
    const std::size_t floats = (simd::residual_scratch(n) + 2 * (size + 16)) * sizeof(float);
    visible_.resize(size);
    memory_.resize((doubles > floats ? doubles : floats) + kAlignment);
  }
  /// Kernels answer Status::invalid_argument for patches of more pixels than this.
  int capacity() const noexcept { return static_cast<int>(visible_.size()); }

  /// The visible set of the last linearise_*() or residuals() call that got as far as looking at the pixels: a byte for each
  /// pixel of its patch, 1 where visible. evaluate() leaves it alone, so that it can be passed there as `on_set`.
  const std::uint8_t* visible() const noexcept { return visible_.data(); }

  /// Buffers of the double reference, and that of the float kernels, which lies in the same memory.
  std::uint8_t* visible_flags() noexcept { return visible_.data(); }
  /// Room for a number a pixel: the host's intensities.
  double* host() noexcept { return reinterpret_cast<double*>(aligned()); }
  /// Room for a number a pixel: the target's intensities.
  double* target() noexcept { return host() + visible_.size(); }
  /// Room for the derivatives, a row a pixel.
  double* rows() noexcept { return target() + visible_.size(); }
  /// The same memory, as the float kernels use it.
  float* scratch() noexcept { return reinterpret_cast<float*>(aligned()); }
  /// 2 (capacity() + 16) floats more, for the kernels of linearise_by().
  float* more_scratch() noexcept { return scratch() + simd::residual_scratch(capacity()); }

 private:
  static constexpr std::size_t kMaxRow = 9, kAlignment = 64;

  unsigned char* aligned() noexcept {
    const auto address = reinterpret_cast<std::uintptr_t>(memory_.data());
    return memory_.data() + (kAlignment - address % kAlignment) % kAlignment;
  }

  std::vector<std::uint8_t> visible_;
  std::vector<unsigned char> memory_;
};

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_PHOTOMETRY_RESIDUAL_TYPES_HPP
