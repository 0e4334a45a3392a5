#include "detectors/dnn_detector.hpp"

#include <array>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "detectors/quiet_opencv.hpp"
#include "io/input_error.hpp"

namespace textslam {
namespace {

constexpr int kTryOut = 64;  // px

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
  std::vector<cv::Mat> maps = forward(cv::Mat(kTryOut, kTryOut, CV_8UC3, cv::Scalar::all(128)), {kTryOut, kTryOut});
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

std::vector<cv::Mat> DnnDetector::forward(const cv::Mat& image, const NetworkSize& size) {
  const std::array<int, 4> shape = {1, 3, size.height, size.width};
  cv::Mat blob(4, shape.data(), CV_32F);
  network_input({image.data, image.cols, image.rows}, is_east() ? kEastColours : kDbColours, size, blob.ptr<float>());
  // OpenCV 4.6 keeps what it derived from the first size, and computes nonsense with another.
  const cv::Size loading_for(size.width, size.height);
  if (net_.empty() || loaded_for_ != loading_for) net_ = cv::dnn::readNet(model_);
  loaded_for_ = loading_for;
  net_.setInput(blob);
  std::vector<cv::Mat> maps;
  net_.forward(maps, outputs_);
  return maps;
}

std::vector<Detection> DnnDetector::detect(const FrameRef& frame, ImageView8 raw_image) {
  if (!raw_image.valid()) return {};
  const int width = raw_image.width(), height = raw_image.height();
  const NetworkSize size = network_size(width, height, parameters_.long_side);
  std::vector<Detection> found;
  try {
    const QuietOpenCv quiet;
    const std::vector<cv::Mat> maps = forward(in_colour(frame, raw_image), size);
    const int rows = maps[0].size[2], columns = maps[0].size[3];
    found = is_east() ? decode_east({rows, columns, maps[0].ptr<float>(), maps[1].ptr<float>()}, parameters_.east)
                      : decode_db({rows, columns, maps[0].ptr<float>()}, parameters_.db);
  } catch (const cv::Exception&) {
    throw InputError(frame.path, frame.line, "the network fails on an image of this size");
  }
  for (Detection& detection : found) to_image(size, width, height, &detection.quad);
  return found;
}

std::unique_ptr<TextDetector> make_dnn_detector(const DetectorOptions& options, const Sequence&) {
  return std::make_unique<DnnDetector>(options.model.empty() ? TEXTSLAM_DEFAULT_MODEL : options.model);
}

}  // namespace textslam
