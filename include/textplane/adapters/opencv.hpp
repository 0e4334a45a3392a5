// OpenCV: images without copies and as pyramids, points, cameras and poses, and the boxes of text detectors as quads.
//
// Both libraries put the centre of the top-left pixel at (0, 0) and order distortion as k1 k2 p1 p2 k3, so only types
// are converted. Needs OpenCV's core module alone. No function throws but for memory; any number of threads.
#ifndef TEXTPLANE_ADAPTERS_OPENCV_HPP
#define TEXTPLANE_ADAPTERS_OPENCV_HPP

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <opencv2/core.hpp>
#include <type_traits>
#include <vector>

#ifndef TEXTPLANE_SINGLE_HEADER
#include "textplane/core/cameras/any_camera.hpp"
#include "textplane/core/image_view.hpp"
#include "textplane/core/se3.hpp"
#include "textplane/core/status.hpp"
#include "textplane/geometry/quad.hpp"
#include "textplane/photometry/pyramid.hpp"
#endif

TEXTPLANE_BEGIN_NAMESPACE

namespace adapters {

/// A view of the pixels of `image`, without a copy: the image must outlive the view and keep its buffer. T is
/// std::uint8_t (CV_8UC1) or float (CV_32FC1), const or not. Regions of interest and padded rows are fine.
/// invalid_argument, and *view empty, for any other type or number of channels (convert colour with cv::cvtColor), an
/// empty image, or more than two dimensions.
template <class T>
Status view(const cv::Mat& image, ImageView<T>* view) noexcept {
  using Pixel = std::remove_const_t<T>;
  static_assert(std::is_same<Pixel, std::uint8_t>::value || std::is_same<Pixel, float>::value,
                "textplane: images are 8-bit or float");
  constexpr int type = std::is_same<Pixel, float>::value ? CV_32FC1 : CV_8UC1;
  *view = {};
  if (image.empty() || image.dims != 2 || image.type() != type) return Status::invalid_argument;
  *view = ImageView<T>(reinterpret_cast<T*>(image.data), image.cols, image.rows,
                       static_cast<std::ptrdiff_t>(image.step[0]));
  return Status::ok;
}

/// A cv::Mat of the pixels of a view, without a copy (for cv::imwrite). Empty for a view that is not valid(). cv::Mat
/// has no constant pixels: do not write to those of a constant view.
template <class T>
cv::Mat to_mat(const ImageView<T>& view) {
  using Pixel = std::remove_const_t<T>;
  static_assert(std::is_same<Pixel, std::uint8_t>::value || std::is_same<Pixel, float>::value,
                "textplane: images are 8-bit or float");
  if (!view.valid()) return {};
  return {view.height(), view.width(), std::is_same<Pixel, float>::value ? CV_32FC1 : CV_8UC1,
          const_cast<Pixel*>(view.data()), static_cast<std::size_t>(view.stride())};
}

namespace detail {
// BT.601 as OpenCV rounds it: the image of one channel that cv::cvtColor makes of 8-bit BGR or BGRA.
inline void grey_of(const cv::Mat& image, std::uint8_t* grey) noexcept {
  constexpr int blue = 3735, green = 19235, red = 9798, bits = 15;
  const int channels = image.channels();
  for (int y = 0; y < image.rows; ++y) {
    const std::uint8_t* from = image.ptr<std::uint8_t>(y);
    for (int x = 0; x < image.cols; ++x, from += channels)
      *grey++ =
          static_cast<std::uint8_t>((blue * from[0] + green * from[1] + red * from[2] + (1 << (bits - 1))) >> bits);
  }
}
}  // namespace detail

/// The pyramid of an image, which may go afterwards. CV_8UC1 is copied once, into the pyramid. CV_8UC3 and CV_8UC4 are
/// taken for BGR and BGRA, as cv::imread gives them, and become grey as by cv::cvtColor. Regions of interest and
/// padded rows are fine. invalid_argument, and a pyramid without levels, for an empty image, more than two dimensions,
/// `levels` outside [1, kMaxPyramidLevels], or any other type: what black and white are in 16 bits only its owner knows
/// (cv::Mat::convertTo).
inline Status pyramid_from_cv(const cv::Mat& image, Pyramid* pyramid, int levels = 4) {
  ImageView8 grey;
  std::vector<std::uint8_t> pixels;
  if (!image.empty() && image.dims == 2 && (image.type() == CV_8UC3 || image.type() == CV_8UC4)) {
    pixels.resize(image.total());
    detail::grey_of(image, pixels.data());
    grey = ImageView8(pixels.data(), image.cols, image.rows);
  } else {
    view(image, &grey);
  }
  return pyramid->build(grey, levels);
}
/// The same, for add_keyframe() of a TextMap, which refuses a pyramid without levels.
inline Pyramid pyramid_from_cv(const cv::Mat& image, int levels = 4) {
  Pyramid pyramid;
  pyramid_from_cv(image, &pyramid, levels);
  return pyramid;
}

/// A point of OpenCV.
template <class S>
Vector2<S> from_cv(const cv::Point_<S>& p) noexcept {
  return {p.x, p.y};
}
/// \overload
template <class S>
Vector3<S> from_cv(const cv::Point3_<S>& p) noexcept {
  return {p.x, p.y, p.z};
}
/// The point as OpenCV's type.
template <class S>
cv::Point_<S> to_cv(const Vector2<S>& p) noexcept {
  return {p[0], p[1]};
}
/// \overload
template <class S>
cv::Point3_<S> to_cv(const Vector3<S>& p) noexcept {
  return {p[0], p[1], p[2]};
}
/// The position of a key point of OpenCV's and ORB-SLAM's detectors, px of level 0.
inline Vector2<double> from_cv(const cv::KeyPoint& k) noexcept {
  return {static_cast<double>(k.pt.x), static_cast<double>(k.pt.y)};
}

/// The camera of a 3 x 3 matrix of intrinsics, CV_64F or CV_32F. invalid_argument, and *camera untouched, for another
/// shape or type, skew, or a camera that is not valid().
inline Status camera_from_cv(const cv::Mat& K, Pinhole<double>* camera) noexcept {
  if (K.dims != 2 || K.rows != 3 || K.cols != 3 || (K.type() != CV_64FC1 && K.type() != CV_32FC1))
    return Status::invalid_argument;
  const auto at = [&K](int r, int c) {
    return K.type() == CV_64FC1 ? K.at<double>(r, c) : static_cast<double>(K.at<float>(r, c));
  };
  const Pinhole<double> out(at(0, 0), at(1, 1), at(0, 2), at(1, 2));
  const bool plain = at(0, 1) == 0 && at(1, 0) == 0 && at(2, 0) == 0 && at(2, 1) == 0 && at(2, 2) == 1;
  if (!plain || !out.valid()) return Status::invalid_argument;
  *camera = out;
  return Status::ok;
}

/// The same with a lens: D has 0, 4, 5 or 8 coefficients, or, of cv::fisheye, 4; CV_64F or CV_32F, a row or a column.
/// invalid_argument, and *camera untouched, also for other coefficients of OpenCV (thin prism, tilt) that are not 0.
inline Status camera_from_cv(const cv::Mat& K, const cv::Mat& D, bool fisheye, AnyCamera<double>* camera) noexcept {
  Pinhole<double> pinhole;
  if (!is_ok(camera_from_cv(K, &pinhole))) return Status::invalid_argument;
  double d[14] = {};
  const std::size_t n = D.total();
  if (n > 0 && (D.dims != 2 || (D.rows != 1 && D.cols != 1) || (D.type() != CV_64FC1 && D.type() != CV_32FC1)))
    return Status::invalid_argument;
  if (fisheye ? n != 4 : (n != 0 && n != 4 && n != 5 && n != 8 && n != 12 && n != 14)) return Status::invalid_argument;
  for (std::size_t i = 0; i < n; ++i) {
    const int k = static_cast<int>(i), row = D.rows > 1 ? k : 0, column = D.rows > 1 ? 0 : k;
    d[i] = D.type() == CV_64FC1 ? D.at<double>(row, column) : static_cast<double>(D.at<float>(row, column));
    if (i >= 8 && d[i] != 0) return Status::invalid_argument;
  }
  const AnyCamera<double> out = [&]() -> AnyCamera<double> {
    if (fisheye) return KannalaBrandt<double>{pinhole, d[0], d[1], d[2], d[3]};
    if (d[5] != 0 || d[6] != 0 || d[7] != 0)
      return Rational<double>{pinhole, d[0], d[1], d[2], d[3], d[4], d[5], d[6], d[7]};
    if (n > 0) return RadialTangential<double>{pinhole, d[0], d[1], d[2], d[3], d[4]};
    return pinhole;
  }();
  if (!out.valid()) return Status::invalid_argument;
  *camera = out;
  return Status::ok;
}

/// The pose of a rotation vector and a translation. cv::solvePnP gives T_c_w, world to camera.
inline SE3d pose_from_cv(const cv::Vec3d& rotation, const cv::Vec3d& translation) noexcept {
  return {so3_exp(Vector3<double>(rotation[0], rotation[1], rotation[2])),
          Vector3<double>(translation[0], translation[1], translation[2])};
}
/// Its inverse.
inline void pose_to_cv(const SE3d& T, cv::Vec3d* rotation, cv::Vec3d* translation) noexcept {
  const Vector3<double> w = so3_log(T.R);
  *rotation = {w[0], w[1], w[2]};
  *translation = {T.t[0], T.t[1], T.t[2]};
}

/// Four corners of either orientation, starting anywhere, as a quad: clockwise from the text's top left.
///
/// Detectors that fit rectangles to blobs (cv::minAreaRect, cv::dnn's DB) do not know where a word begins. The top is
/// the longer side along which text reads to the right, or downwards if vertical; upside-down signs count as upright.
/// degenerate for corners that are not convex, non_finite for NaN; *out is then untouched.
inline Status reading_order(const Quad<double>& corners, Quad<double>* out) noexcept {
  if (!all_finite(corners)) return Status::non_finite;
  if (!is_convex(corners)) return Status::degenerate;
  Quad<double> q = corners;
  if (area(q) < 0) q.corner = {corners.corner[0], corners.corner[3], corners.corner[2], corners.corner[1]};
  const auto side = [&q](std::size_t i) { return Vector2<double>(q.corner[(i + 1) % 4] - q.corner[i % 4]); };
  const std::size_t pair = side(0).norm() + side(2).norm() >= side(1).norm() + side(3).norm() ? 0 : 1;
  // The mean direction of the two longer sides, with the first as the top.
  const Vector2<double> along = side(pair) - side(pair + 2);
  const bool steep = std::abs(along[0]) <= 1e-6 * std::abs(along[1]);
  const std::size_t first = (steep ? along[1] > 0 : along[0] > 0) ? pair : pair + 2;
  for (std::size_t i = 0; i < 4; ++i) out->corner[i] = q.corner[(first + i) % 4];
  return Status::ok;
}

/// The quad of a rotated rectangle, in reading_order(): cv::dnn::TextDetectionModel::detectTextRectangles,
/// cv::minAreaRect.
inline Status quad_from_cv(const cv::RotatedRect& box, Quad<double>* out) noexcept {
  std::array<cv::Point2f, 4> p;
  box.points(p.data());
  Quad<double> corners;
  for (std::size_t i = 0; i < 4; ++i) corners.corner[i] = {static_cast<double>(p[i].x), static_cast<double>(p[i].y)};
  return reading_order(corners, out);
}

/// The quad of four points, in reading_order(): cv::dnn::TextDetectionModel::detect, cv::boxPoints. invalid_argument
/// for any other number of points.
template <class S>
Status quad_from_cv(const std::vector<cv::Point_<S>>& points, Quad<double>* out) noexcept {
  if (points.size() != 4) return Status::invalid_argument;
  Quad<double> corners;
  for (std::size_t i = 0; i < 4; ++i)
    corners.corner[i] = {static_cast<double>(points[i].x), static_cast<double>(points[i].y)};
  return reading_order(corners, out);
}

/// The corners, for cv::polylines.
inline std::vector<cv::Point2f> to_cv(const Quad<double>& quad) {
  std::vector<cv::Point2f> out;
  for (const Vector2<double>& c : quad.corner) out.emplace_back(static_cast<float>(c[0]), static_cast<float>(c[1]));
  return out;
}

}  // namespace adapters

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_ADAPTERS_OPENCV_HPP
