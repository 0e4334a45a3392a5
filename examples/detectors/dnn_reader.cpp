#include "detectors/dnn_reader.hpp"

#include <array>
#include <filesystem>

#include "detectors/quiet_opencv.hpp"
#include "io/input_error.hpp"
#include "io/text_file.hpp"

namespace textslam {
namespace {

std::string letters_file(const std::string& model) {
  return std::filesystem::path(model).replace_extension(".txt").string();
}

}  // namespace

DnnReader::DnnReader(const std::string& model, const RecogniserParameters& parameters) : parameters_(parameters) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(model, error))
    throw InputError(model, 0, "no such model; scripts/get-detector --reader obtains one, --words-model names another");
  for (const TextLine& line : read_lines(letters_file(model))) letters_.push_back(line.text);
  const QuietOpenCv quiet;
  cv::Mat output;
  try {
    net_ = cv::dnn::readNet(model);
    output = forward(Image<std::uint8_t>(parameters_.width, parameters_.height, 128));
  } catch (const cv::Exception&) {
    throw InputError(model, 0, "not a text recogniser: OpenCV " CV_VERSION " cannot load or run it");
  }
  if (output.dims != 3 || output.type() != CV_32F || output.size[0] != 1)
    throw InputError(model, 0, "not a text recogniser: its output has another shape");
  if (static_cast<std::size_t>(output.size[2]) != letters_.size() + 2)
    throw InputError(
        letters_file(model), 0,
        std::to_string(letters_.size()) + " letters, but the network knows " + std::to_string(output.size[2] - 2));
}

cv::Mat DnnReader::forward(const Image<std::uint8_t>& picture) {
  const std::array<int, 4> shape = {1, 3, parameters_.height, parameters_.width};
  cv::Mat blob(4, shape.data(), CV_32F);
  recogniser_input(picture, parameters_.width, parameters_.height, blob.ptr<float>());
  net_.setInput(blob);
  return net_.forward();
}

TextReader::Reading DnnReader::read(ImageView8 raw_image, const Quad<double>& quad) {
  const Image<std::uint8_t> picture = recogniser_picture(raw_image, quad, parameters_);
  if (picture.width() == 0) return {};
  const QuietOpenCv quiet;
  const cv::Mat output = forward(picture);
  return read_word(output.ptr<float>(), output.size[1], output.size[2], letters_, parameters_);
}

std::unique_ptr<TextReader> make_dnn_reader(const DetectorOptions& options) {
  return std::make_unique<DnnReader>(options.words_model.empty() ? TEXTSLAM_DEFAULT_READER : options.words_model);
}

bool is_dnn_reader_ready(const DetectorOptions& options) {
  std::error_code error;
  return !options.words_model.empty() || std::filesystem::is_regular_file(TEXTSLAM_DEFAULT_READER, error);
}

}  // namespace textslam
