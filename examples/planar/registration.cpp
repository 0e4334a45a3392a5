#include "planar/registration.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

namespace planar {

namespace {
constexpr int kCornersToTrack = 1500, kHalf = 15, kReach = 4, kLeast = 12;  // px, but for the first and the last
constexpr double kBlur = 4, kNoise = 4, kDistance = 12;                     // px, grey levels, px
constexpr double kCorrelation = 0.7, kThereAndBack = 0.3, kAgree = 0.5;     // none, px, px

/// The position in the other photograph of the square round `at`, refined by parabolas. False where it leaves either
/// photograph, correlates with nothing within reach, or best at the edge of the reach.
bool find_square(const cv::Mat& from, const cv::Mat& to, cv::Point at, cv::Point2d* found) {
  const cv::Rect square(at.x - kHalf, at.y - kHalf, 2 * kHalf + 1, 2 * kHalf + 1);
  const cv::Rect around(square.x - kReach, square.y - kReach, square.width + 2 * kReach, square.height + 2 * kReach);
  if ((around & cv::Rect(0, 0, from.cols, from.rows)) != around) return false;
  cv::Mat score;
  cv::matchTemplate(to(around), from(square), score, cv::TM_CCOEFF_NORMED);
  cv::Point p;
  double best = 0;
  cv::minMaxLoc(score, nullptr, &best, nullptr, &p);
  if (!(best >= kCorrelation) || p.x == 0 || p.y == 0 || p.x == 2 * kReach || p.y == 2 * kReach) return false;
  const auto s = [&](int dx, int dy) { return static_cast<double>(score.at<float>(p.y + dy, p.x + dx)); };
  const auto top = [&](double low, double high) { return 0.5 * (low - high) / (low - 2 * s(0, 0) + high); };
  *found = {at.x + p.x - kReach + top(s(-1, 0), s(1, 0)), at.y + p.y - kReach + top(s(0, -1), s(0, 1))};
  return true;
}
}  // namespace

cv::Mat compare(const cv::Mat& grey) {
  cv::Mat value, mean, deviation;
  grey.convertTo(value, CV_32F);
  cv::GaussianBlur(value, mean, {}, kBlur);
  cv::GaussianBlur(value.mul(value), deviation, {}, kBlur);
  cv::sqrt(cv::max(deviation - mean.mul(mean), 0), deviation);
  return (value - mean) / (deviation + kNoise);
}

Registration register_still(const cv::Mat& first, const cv::Mat& other) {
  cv::Mat bytes;
  first.convertTo(bytes, CV_8U, 32, 128);
  std::vector<cv::Point2f> corners, from, to;
  cv::goodFeaturesToTrack(bytes, corners, kCornersToTrack, 0.01, kDistance);
  for (const cv::Point2f& corner : corners) {
    const cv::Point at(cvRound(corner.x), cvRound(corner.y));
    cv::Point2d there, back;
    if (!find_square(first, other, at, &there)) continue;
    const cv::Point near(cvRound(there.x), cvRound(there.y));
    if (!find_square(other, first, near, &back)) continue;
    if (cv::norm((there - cv::Point2d(at)) + (back - cv::Point2d(near))) > kThereAndBack) continue;
    from.emplace_back(at);
    to.emplace_back(there);
  }
  std::vector<std::uint8_t> agree;
  cv::Mat A;
  if (from.size() >= kLeast) A = cv::estimateAffinePartial2D(from, to, agree, cv::RANSAC, kAgree, 5000, 0.999, 20);
  Registration out;
  for (int r = 0; r < 2 && !A.empty(); ++r)
    for (int c = 0; c < 3; ++c) out.H(r, c) = A.at<double>(r, c);
  for (std::size_t i = 0; i < agree.size(); ++i) {
    if (!agree[i]) continue;
    const tp::Vector3<double> p = out.H * tp::Vector3<double>(from[i].x, from[i].y, 1);
    out.residual += std::hypot(p[0] - to[i].x, p[1] - to[i].y);
    ++out.matches;
  }
  if (out.matches < kLeast) throw std::runtime_error("two photographs of a scene are not alike");
  out.residual /= out.matches;
  return out;
}

Consistency round_trips(const std::vector<std::vector<Registration>>& from, const std::vector<cv::Point2d>& points) {
  Consistency out;
  int count = 0;
  for (std::size_t i = 1; i < from.size(); ++i)
    for (std::size_t j = i + 1; j < from.size(); ++j)
      for (const cv::Point2d& p : points) {
        const tp::Vector3<double> at(p.x, p.y, 1);
        const double off = (from[i][j].H * from[0][i].H * at - from[0][j].H * at).norm();
        out.mean += off;
        out.largest = std::max(out.largest, off);
        ++count;
      }
  if (count > 0) out.mean /= count;
  return out;
}

}  // namespace planar
