// ImageView: pixels that someone else owns, with a stride. Image: the plain owner that pyramids and examples use.
//
// The centre of the top-left pixel is (0, 0). Strides are in bytes and may exceed the row; they may not be smaller.
#ifndef TEXTPLANE_CORE_IMAGE_VIEW_HPP
#define TEXTPLANE_CORE_IMAGE_VIEW_HPP

#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <vector>

#include "textplane/config.hpp"
#include "textplane/core/numeric.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// A view of width x height pixels of type T (std::uint8_t or float, possibly const). Copying copies the view.
/// No function of the library reads outside [data, data + (height - 1) * stride + width * sizeof(T)).
template <class T>
class ImageView {
 public:
  using Pixel = T;  ///< const where the view may not write.
  /// A byte of the same constness: strides count these.
  using Byte = std::conditional_t<std::is_const<T>::value, const unsigned char, unsigned char>;

  constexpr ImageView() noexcept = default;
  /// Rows without gaps.
  ImageView(T* data, int width, int height) noexcept
      : ImageView(data, width, height, static_cast<std::ptrdiff_t>(width) * static_cast<std::ptrdiff_t>(sizeof(T))) {}
  /// `stride`: distance of two rows in bytes.
  ImageView(T* data, int width, int height, std::ptrdiff_t stride) noexcept
      : data_(data), width_(width), height_(height), stride_(stride) {}
  /// A view of mutable pixels converts to one of constant pixels.
  template <class U, std::enable_if_t<std::is_same<T, const U>::value, int> = 0>
  ImageView(const ImageView<U>& other) noexcept
      : data_(other.data()), width_(other.width()), height_(other.height()), stride_(other.stride()) {}

  T* data() const noexcept { return data_; }                  ///< The top-left pixel.
  int width() const noexcept { return width_; }               ///< px.
  int height() const noexcept { return height_; }             ///< px.
  std::ptrdiff_t stride() const noexcept { return stride_; }  ///< Bytes from one row to the next.

  /// Not null, not empty, and no row overlaps the next.
  bool valid() const noexcept {
    return data_ != nullptr && width_ > 0 && height_ > 0 &&
           stride_ >= static_cast<std::ptrdiff_t>(width_) * static_cast<std::ptrdiff_t>(sizeof(T));
  }

  /// The first pixel of row y, not checked.
  T* row(int y) const noexcept {
    return reinterpret_cast<T*>(reinterpret_cast<Byte*>(data_) + static_cast<std::ptrdiff_t>(y) * stride_);
  }
  T& operator()(int x, int y) const noexcept { return row(y)[x]; }  ///< The pixel at column x, row y, not checked.

  /// (x, y) lies in [0, width - 1] x [0, height - 1], where bilinear interpolation is defined. False for NaN.
  template <class S>
  bool contains(const S& x, const S& y) const noexcept {
    return is_finite(x) && is_finite(y) && x >= S(0) && y >= S(0) && x <= S(width_ - 1) && y <= S(height_ - 1);
  }

 private:
  T* data_ = nullptr;
  int width_ = 0;
  int height_ = 0;
  std::ptrdiff_t stride_ = 0;
};

/// An image that owns its pixels, rows without gaps. Construction and resize() allocate, nothing else does.
template <class T>
class Image {
 public:
  Image() = default;
  /// An image of width x height px, filled with `value`.
  Image(int width, int height, T value = T()) { resize(width, height, value); }

  /// Makes it width x height px, filled with `value`.
  void resize(int width, int height, T value = T()) {
    width_ = width > 0 ? width : 0;
    height_ = height > 0 ? height : 0;
    pixels_.assign(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_), value);
  }

  int width() const noexcept { return width_; }                                      ///< px.
  int height() const noexcept { return height_; }                                    ///< px.
  bool empty() const noexcept { return pixels_.empty(); }                            ///< Without pixels.
  T* data() noexcept { return pixels_.data(); }                                      ///< The top-left pixel.
  const T* data() const noexcept { return pixels_.data(); }                          ///< Likewise.
  T& operator()(int x, int y) noexcept { return pixels_[index(x, y)]; }              ///< Column x, row y; not checked.
  const T& operator()(int x, int y) const noexcept { return pixels_[index(x, y)]; }  ///< Likewise.
  T* row(int y) noexcept { return pixels_.data() + index(0, y); }                    ///< Its first pixel; not checked.
  const T* row(int y) const noexcept { return pixels_.data() + index(0, y); }        ///< Likewise.

  /// A view of the whole image, valid until the image is resized or destroyed.
  ImageView<T> view() noexcept { return {pixels_.data(), width_, height_}; }
  /// \overload
  ImageView<const T> view() const noexcept { return {pixels_.data(), width_, height_}; }

 private:
  std::size_t index(int x, int y) const noexcept {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
  }

  int width_ = 0;
  int height_ = 0;
  std::vector<T> pixels_;
};

using ImageView8 = ImageView<const std::uint8_t>;  ///< Grey levels of 8 bits.
using ImageViewF = ImageView<const float>;         ///< Grey levels in float.

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_CORE_IMAGE_VIEW_HPP
