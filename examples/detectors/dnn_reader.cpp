#include "detectors/dnn_reader.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>

#include "detectors/line_picture.hpp"
#include "detectors/quiet_opencv.hpp"
#include "io/input_error.hpp"
#include "io/text_file.hpp"

namespace textslam {
namespace {

std::string letters_file(const std::string& model) {
  return std::filesystem::path(model).replace_extension(".txt").string();
}

}  // namespace

TextReader::Reading decode_ctc(const float* probability, int steps, int classes,
                               const std::vector<std::string>& letters) {
  TextReader::Reading reading;
  reading.text.clear();
  int said = 0, count = 0;
  for (int step = 0; step < steps; ++step) {
    const float* row = probability + static_cast<std::ptrdiff_t>(step) * classes;
    const int best = static_cast<int>(std::max_element(row, row + classes) - row);
    if (best != 0 && best != said) {
      reading.text += best == classes - 1 ? " " : letters[static_cast<std::size_t>(best - 1)];
      reading.score += static_cast<double>(row[best]);
      ++count;
    }
    said = best;
  }
  if (count > 0) reading.score /= count;
  return reading;
}

DnnReader::DnnReader(const std::string& model, const DnnReaderParameters& parameters) : parameters_(parameters) {
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
  cv::Mat blob(4, shape.data(), CV_32F, cv::Scalar(0));
  for (int c = 0; c < 3; ++c)
    for (int y = 0; y < std::min(parameters_.height, picture.height()); ++y) {
      float* row = blob.ptr<float>(0, c) + static_cast<std::ptrdiff_t>(y) * parameters_.width;
      for (int x = 0; x < std::min(parameters_.width, picture.width()); ++x)
        row[x] = static_cast<float>(picture(x, y)) / 127.5F - 1;
    }
  net_.setInput(blob);
  return net_.forward();
}

TextReader::Reading DnnReader::read(ImageView8 raw_image, const Quad<double>& quad) {
  const double inner = parameters_.height / (1 + 2 * parameters_.margin);
  const double longest = parameters_.width / inner - 2 * parameters_.margin;
  const Image<std::uint8_t> picture =
      line_picture(raw_image, quad, static_cast<int>(std::lround(inner)), parameters_.margin, longest);
  if (picture.width() == 0) return {};
  const QuietOpenCv quiet;
  const cv::Mat output = forward(picture);
  Reading reading = decode_ctc(output.ptr<float>(), output.size[1], output.size[2], letters_);
  reading.text = word_of(reading.text);
  if (reading.text.empty() || reading.score < parameters_.min_confidence) return {};
  return reading;
}

std::unique_ptr<TextReader> make_dnn_reader(const DetectorOptions& options) {
  return std::make_unique<DnnReader>(options.words_model.empty() ? TEXTSLAM_DEFAULT_READER : options.words_model);
}

bool is_dnn_reader_ready(const DetectorOptions& options) {
  std::error_code error;
  return !options.words_model.empty() || std::filesystem::is_regular_file(TEXTSLAM_DEFAULT_READER, error);
}

}  // namespace textslam
