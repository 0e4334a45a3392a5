#include "planar/peers.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

#include "textplane/geometry/quad_projection.hpp"

namespace planar {

namespace {
using Matrix = tp::Matrix3<double>;

constexpr int kIterations = 50, kMargin = 24, kCorners = 500, kLeastPixels = 15;
constexpr double kEpsilon = 1e-4;

/// Pixels of level 0 to those of level l.
Matrix to_level(int level) {
  const double scale = std::ldexp(1.0, -level);
  Matrix S = Matrix::Identity();
  S(0, 0) = S(1, 1) = scale;
  S(0, 2) = S(1, 2) = 0.5 * scale - 0.5;
  return S;
}

Matrix shift(double x, double y) {
  Matrix T = Matrix::Identity();
  T(0, 2) = x;
  T(1, 2) = y;
  return T;
}

cv::Rect box_of(const tp::Quad<double>& quad, int margin, const tp::ImageView8& image) {
  const auto b = tp::bounds(quad);
  const int x0 = static_cast<int>(std::floor(b.min[0])) - margin, y0 = static_cast<int>(std::floor(b.min[1])) - margin;
  const int x1 = static_cast<int>(std::ceil(b.max[0])) + margin, y1 = static_cast<int>(std::ceil(b.max[1])) + margin;
  return cv::Rect(x0, y0, x1 - x0 + 1, y1 - y0 + 1) & cv::Rect(0, 0, image.width(), image.height());
}

cv::Mat mat_of(const tp::ImageView8& image) {
  return {image.height(), image.width(), CV_8U, const_cast<std::uint8_t*>(image.data()),
          static_cast<std::size_t>(image.stride())};
}
}  // namespace

bool align_ecc(const tp::PyramidView& first, const tp::Quad<double>& quad, const tp::PyramidView& image, Matrix* H) {
  Matrix found = *H;
  for (int level = std::min(first.levels, image.levels) - 1; level >= 0; --level) {
    const auto l = static_cast<std::size_t>(level);
    const Matrix S = to_level(level);
    Matrix H_l = S * found * S.inverse();
    const tp::Quad<double> from = tp::quad_to_level(quad, level);
    tp::Quad<double> to;
    if (!tp::is_ok(tp::transform(from, H_l, &to))) return false;
    const cv::Rect patch = box_of(from, 0, first.level[l]), around = box_of(to, kMargin, image.level[l]);
    if (patch.area() < 64 || around.area() < 64) return false;
    H_l = shift(-around.x, -around.y) * H_l * shift(patch.x, patch.y);
    H_l /= H_l(2, 2);
    cv::Mat warp(3, 3, CV_32F);
    for (int i = 0; i < 9; ++i) warp.at<float>(i / 3, i % 3) = static_cast<float>(H_l(i / 3, i % 3));
    try {
      cv::findTransformECC(mat_of(first.level[l])(patch), mat_of(image.level[l])(around), warp, cv::MOTION_HOMOGRAPHY,
                           {cv::TermCriteria::COUNT | cv::TermCriteria::EPS, kIterations, kEpsilon});
    } catch (const cv::Exception&) {
      if (level == 0) return false;
      continue;  // skip a coarse level that does not converge
    }
    for (int i = 0; i < 9; ++i) H_l(i / 3, i % 3) = static_cast<double>(warp.at<float>(i / 3, i % 3));
    found = S.inverse() * shift(around.x, around.y) * H_l * shift(-patch.x, -patch.y) * S;
  }
  *H = found;
  return found.allFinite();
}

bool refine_whole(tp::ImageView8 first, tp::ImageView8 image, Matrix* H) {
  cv::Mat warp(3, 3, CV_32F);
  *H /= (*H)(2, 2);
  for (int i = 0; i < 9; ++i) warp.at<float>(i / 3, i % 3) = static_cast<float>((*H)(i / 3, i % 3));
  try {
    cv::findTransformECC(mat_of(first), mat_of(image), warp, cv::MOTION_HOMOGRAPHY,
                         {cv::TermCriteria::COUNT | cv::TermCriteria::EPS, kIterations, 1e-6});
  } catch (const cv::Exception&) {
    return false;
  }
  for (int i = 0; i < 9; ++i) (*H)(i / 3, i % 3) = static_cast<double>(warp.at<float>(i / 3, i % 3));
  return true;
}

bool align_ssd(const tp::TextPatch& patch, const tp::PyramidView& image, Matrix* H) {
  using Vector8 = Eigen::Matrix<double, 8, 1>;
  Matrix found = *H;
  for (int level = std::min(patch.level_count(), image.levels) - 1; level >= 0; --level) {
    const tp::PatchView p = patch.levels[static_cast<std::size_t>(level)].view();
    if (level > 0 && p.n < kLeastPixels) continue;
    const tp::ImageView8& target = image.level[static_cast<std::size_t>(level)];
    const Matrix S = to_level(level);
    Matrix H_l = S * found * S.inverse();
    H_l /= H_l(2, 2);
    // Mean squared difference and, on request, its normal equations.
    const auto cost = [&](const Matrix& G, Eigen::Matrix<double, 8, 8>* A, Vector8* b) {
      double sum = 0;
      int n = 0;
      for (int i = 0; i < p.n; ++i) {
        const double x = static_cast<double>(p.x[i]), y = static_cast<double>(p.y[i]);
        const tp::Vector3<double> q = G * tp::Vector3<double>(x, y, 1);
        const double u = q[0] / q[2], v = q[1] / q[2];
        double value = 0, gx = 0, gy = 0;
        if (!(q[2] > 0) || !tp::sample_bilinear(target, u, v, &value, &gx, &gy)) continue;
        const double r = static_cast<double>(p.intensity[i]) - value;
        sum += r * r;
        ++n;
        if (!A) continue;
        const double d = -(gx * u + gy * v);
        Vector8 j;
        j << gx * x, gx * y, gx, gy * x, gy * y, gy, d * x, d * y;
        j /= q[2];
        A->noalias() += j * j.transpose();
        *b += j * r;
      }
      return n >= kLeastPixels ? sum / n : -1.0;
    };
    double lambda = 1e-4;
    for (int k = 0; k < kIterations; ++k) {
      Eigen::Matrix<double, 8, 8> A = Eigen::Matrix<double, 8, 8>::Zero();
      Vector8 b = Vector8::Zero();
      const double now = cost(H_l, &A, &b);
      if (now < 0) return false;
      A.diagonal() *= 1 + lambda;
      const Vector8 step = A.ldlt().solve(b);
      Matrix next = H_l;
      for (int i = 0; i < 8; ++i) next(i / 3, i % 3) += step[i];
      const double then = cost(next, nullptr, nullptr);
      if (!(then >= 0 && then < now)) {
        lambda *= 10;
        if (lambda > 1e6) break;
        continue;
      }
      lambda = std::max(lambda / 10, 1e-9);
      H_l = next;
      if (now - then < 1e-6 * now) break;
    }
    found = S.inverse() * H_l * S;
  }
  *H = found;
  return found.allFinite();
}

KltHomography::KltHomography(const cv::Mat& first, const tp::Quad<double>& quad) : last_(first.clone()) {
  cv::Mat mask = cv::Mat::zeros(first.size(), CV_8U);
  std::vector<cv::Point> corners;
  for (const auto& c : quad.corner) corners.emplace_back(cvRound(c[0]), cvRound(c[1]));
  cv::fillConvexPoly(mask, corners, cv::Scalar(255));
  cv::goodFeaturesToTrack(first, first_points_, kCorners, 0.01, 5, mask);
  points_ = first_points_;
}

bool KltHomography::track(const cv::Mat& image, Matrix* H) {
  if (points_.size() < 4) return false;
  std::vector<cv::Point2f> next;
  std::vector<std::uint8_t> status;
  std::vector<float> error;
  cv::calcOpticalFlowPyrLK(last_, image, points_, next, status, error);
  std::size_t n = 0;
  for (std::size_t i = 0; i < next.size(); ++i)
    if (status[i]) {
      first_points_[n] = first_points_[i];
      points_[n++] = next[i];
    }
  first_points_.resize(n);
  points_.resize(n);
  last_ = image.clone();
  if (n < 4) return false;
  const cv::Mat found = cv::findHomography(first_points_, points_, cv::RANSAC, 3.0);
  if (found.empty()) return false;
  for (int i = 0; i < 9; ++i) (*H)(i / 3, i % 3) = found.at<double>(i / 3, i % 3);
  return true;
}

}  // namespace planar
