// PhotometricWorkspace: the scratch memory of the photometric kernels.
#ifndef TEXTPLANE_PHOTOMETRY_PHOTOMETRIC_WORKSPACE_HPP
#define TEXTPLANE_PHOTOMETRY_PHOTOMETRIC_WORKSPACE_HPP

#include <cstddef>
#include <cstdint>
#include <vector>

#include "textplane/simd/residual.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// Scratch memory of the photometric kernels: one for each thread, for any number of calls.
class PhotometricWorkspace {
 public:
  PhotometricWorkspace() = default;
  explicit PhotometricWorkspace(int n) { reserve(n); }  ///< With room for n pixels.

  /// Makes room for patches of n pixels: some 90 bytes a pixel. The only member that allocates; never shrinks.
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

  /// The visible set of the last linearise() or residuals() that got as far as looking at the pixels: a byte for each
  /// pixel of its patch, 1 where visible. evaluate() leaves it alone, so that it can be passed there as `on_set`.
  const std::uint8_t* visible() const noexcept { return visible_.data(); }

  std::uint8_t* visible_flags() noexcept { return visible_.data(); }  ///< Where the kernels write visible().
  /// The reference's buffers. A number a visible pixel: host intensity, then residual.
  double* residuals() noexcept { return reinterpret_cast<double*>(aligned()); }
  /// A number a visible pixel: target intensity, then normalised, then robust weight.
  double* intensities() noexcept { return residuals() + visible_.size(); }
  double* rows() noexcept { return intensities() + visible_.size(); }  ///< A row of derivatives a visible pixel.
  /// The same memory, as the float kernels use it.
  float* scratch() noexcept { return reinterpret_cast<float*>(aligned()); }
  /// 2 (capacity() + 16) floats more, for the kernels of the template and ESM forms.
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

#endif  // TEXTPLANE_PHOTOMETRY_PHOTOMETRIC_WORKSPACE_HPP
