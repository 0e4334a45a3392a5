#include "detectors/db_boxes.hpp"

#include <cmath>
#include <opencv2/imgproc.hpp>
#include <utility>

namespace textslam {
namespace {

constexpr double kTall = 1.5;  // height over width of a text that runs downwards

double mean_inside(const cv::Mat& probability, const std::vector<cv::Point>& outline) {
  const cv::Rect box = cv::boundingRect(outline) & cv::Rect(0, 0, probability.cols, probability.rows);
  cv::Mat mask = cv::Mat::zeros(box.size(), CV_8U);
  cv::fillPoly(mask, std::vector<std::vector<cv::Point>>{outline}, 1, cv::LINE_8, 0, -box.tl());
  return cv::mean(probability(box), mask)[0];
}

// Corners from the text's top left. The text runs along the axis nearest to the horizontal, or downwards if the box is
// tall.
Quad<double> oriented(const cv::RotatedRect& rectangle, double grow) {
  const double turn = static_cast<double>(rectangle.angle) * CV_PI / 180;
  Vector2<double> along(std::cos(turn), std::sin(turn)), down(-along.y(), along.x());
  double half_along = rectangle.size.width / 2.0 + grow, half_down = rectangle.size.height / 2.0 + grow;
  while (std::abs(along.x()) < std::abs(along.y()) || along.x() < 0) {
    const Vector2<double> old = along;
    along = -down;
    down = old;
    std::swap(half_along, half_down);
  }
  if (half_down > kTall * half_along) {
    const Vector2<double> old = along;
    along = down;
    down = -old;
    std::swap(half_along, half_down);
  }
  const Vector2<double> centre(static_cast<double>(rectangle.center.x), static_cast<double>(rectangle.center.y));
  const Vector2<double> a = half_along * along, d = half_down * down;
  Quad<double> quad;
  quad.corner = {centre - a - d, centre + a - d, centre + a + d, centre - a + d};
  return quad;
}

}  // namespace

std::vector<Detection> decode_db(const cv::Mat& probability, const DbParameters& parameters) {
  const cv::Mat core = probability > parameters.min_probability;
  std::vector<std::vector<cv::Point>> outlines;
  cv::findContours(core, outlines, cv::RETR_LIST, cv::CHAIN_APPROX_SIMPLE);
  std::vector<Detection> boxes;
  for (const std::vector<cv::Point>& outline : outlines) {
    const cv::RotatedRect rectangle = cv::minAreaRect(outline);
    const double width = static_cast<double>(rectangle.size.width), height = static_cast<double>(rectangle.size.height);
    if (std::min(width, height) < parameters.min_side) continue;
    Detection box;
    box.score = mean_inside(probability, outline);
    if (box.score < parameters.min_score) continue;
    box.quad = oriented(rectangle, parameters.unclip * width * height / (2 * (width + height)));
    boxes.push_back(box);
  }
  return boxes;
}

}  // namespace textslam
