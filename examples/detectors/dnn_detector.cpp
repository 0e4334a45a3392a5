#include "detectors/dnn_detector.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "detectors/quiet_opencv.hpp"
#include "io/input_error.hpp"

namespace textslam {
namespace {

constexpr int kStep = 32;    // px: what the sides of the input are multiples of
constexpr int kTryOut = 64;  // px

struct Channel {
  double scale, shift;
};
// As in training: (v / 255 - mean) / deviation, blue first, for DB; v - mean, red first, for EAST.
constexpr std::array<Channel, 3> kDbChannels = {
    {{1 / (255 * 0.229), -0.485 / 0.229}, {1 / (255 * 0.224), -0.456 / 0.224}, {1 / (255 * 0.225), -0.406 / 0.225}}};
constexpr std::array<Channel, 3> kEastChannels = {{{1, -123.68}, {1, -116.78}, {1, -103.94}}};

int in_steps(double side) { return kStep * std::max(1, static_cast<int>(std::lround(side / kStep))); }

// Blue, green, red: the frame's own, or from its file, where it is one of this image; else the grey image.
cv::Mat in_colour(const FrameRef& frame, ImageView8 raw_image) {
  if (frame.colour.width() == 3 * raw_image.width() && frame.colour.height() == raw_image.height())
    return {raw_image.height(), raw_image.width(), CV_8UC3, const_cast<std::uint8_t*>(frame.colour.data())};
  cv::Mat colour;
  if (!frame.path.empty()) colour = cv::imread(frame.path, cv::IMREAD_COLOR | cv::IMREAD_IGNORE_ORIENTATION);
  if (colour.cols == raw_image.width() && colour.rows == raw_image.height()) return colour;
  const cv::Mat grey(raw_image.height(), raw_image.width(), CV_8U, const_cast<std::uint8_t*>(raw_image.row(0)),
                     static_cast<std::size_t>(raw_image.stride()));
  cv::cvtColor(grey, colour, cv::COLOR_GRAY2BGR);
  return colour;
}

}  // namespace

DnnDetector::DnnDetector(const std::string& model, const DnnParameters& parameters)
    : model_(model), parameters_(parameters) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(model, error))
    throw InputError(model, 0, "no such model; scripts/get-detector obtains one, --model names another");
  const QuietOpenCv quiet;
  std::string reason;
  try {
    outputs_ = cv::dnn::readNet(model).getUnconnectedOutLayersNames();
    reason = reason_it_is_wrong();
  } catch (const cv::Exception&) {
    reason = "OpenCV " CV_VERSION " cannot load or run it";
  }
  if (!reason.empty()) throw InputError(model, 0, "not a text detector of kind DB or EAST: " + reason);
}

// Tries the network out, and puts EAST's outputs in order.
std::string DnnDetector::reason_it_is_wrong() {
  if (outputs_.empty() || outputs_.size() > 2) return std::to_string(outputs_.size()) + " outputs";
  std::vector<cv::Mat> maps = forward(cv::Mat(kTryOut, kTryOut, CV_8UC3, cv::Scalar::all(128)), kTryOut, kTryOut);
  if (is_east() && maps[0].dims == 4 && maps[0].size[1] == 5) {
    std::swap(outputs_[0], outputs_[1]);
    std::swap(maps[0], maps[1]);
  }
  const int side = is_east() ? kTryOut / 4 : kTryOut;
  for (std::size_t i = 0; i < maps.size(); ++i) {
    const cv::Mat& map = maps[i];
    const bool fits = map.dims == 4 && map.type() == CV_32F && map.size[0] == 1 && map.size[1] == (i == 0 ? 1 : 5) &&
                      map.size[2] == side && map.size[3] == side;
    if (!fits) return "its output " + outputs_[i] + " has another shape";
  }
  return "";
}

std::vector<cv::Mat> DnnDetector::forward(const cv::Mat& image, int width, int height) {
  cv::Mat sized;
  cv::resize(image, sized, cv::Size(width, height), 0, 0, cv::INTER_LINEAR);
  std::vector<cv::Mat> colours;
  cv::split(sized, colours);
  const std::array<int, 4> shape = {1, 3, height, width};
  cv::Mat blob(4, shape.data(), CV_32F);
  for (int c = 0; c < 3; ++c) {
    const Channel& channel = (is_east() ? kEastChannels : kDbChannels)[static_cast<std::size_t>(c)];
    cv::Mat plane(height, width, CV_32F, blob.ptr<float>(0, c));
    colours[static_cast<std::size_t>(is_east() ? 2 - c : c)].convertTo(plane, CV_32F, channel.scale, channel.shift);
  }
  // OpenCV 4.6 keeps what it derived from the first size, and computes nonsense with another.
  if (net_.empty() || loaded_for_ != sized.size()) net_ = cv::dnn::readNet(model_);
  loaded_for_ = sized.size();
  net_.setInput(blob);
  std::vector<cv::Mat> maps;
  net_.forward(maps, outputs_);
  return maps;
}

std::vector<Detection> DnnDetector::detect(const FrameRef& frame, ImageView8 raw_image) {
  if (!raw_image.valid()) return {};
  const double scale = static_cast<double>(parameters_.long_side) / std::max(raw_image.width(), raw_image.height());
  const int width = in_steps(scale * raw_image.width()), height = in_steps(scale * raw_image.height());
  std::vector<Detection> found;
  try {
    const QuietOpenCv quiet;
    const std::vector<cv::Mat> maps = forward(in_colour(frame, raw_image), width, height);
    if (is_east()) {
      found =
          decode_east({maps[0].size[2], maps[0].size[3], maps[0].ptr<float>(), maps[1].ptr<float>()}, parameters_.east);
    } else {
      found = decode_db(cv::Mat(maps[0].size[2], maps[0].size[3], CV_32F, const_cast<float*>(maps[0].ptr<float>())),
                        parameters_.db);
    }
  } catch (const cv::Exception&) {
    throw InputError(frame.path, frame.line, "the network fails on an image of this size");
  }
  // Pixel centres are at whole numbers in both images.
  const Vector2<double> step(static_cast<double>(raw_image.width()) / width,
                             static_cast<double>(raw_image.height()) / height);
  for (Detection& detection : found)
    for (Vector2<double>& corner : detection.quad.corner) corner = (corner.array() + 0.5) * step.array() - 0.5;
  return found;
}

std::unique_ptr<TextDetector> make_dnn_detector(const DetectorOptions& options, const Sequence&) {
  return std::make_unique<DnnDetector>(options.model.empty() ? TEXTSLAM_DEFAULT_MODEL : options.model);
}

}  // namespace textslam
