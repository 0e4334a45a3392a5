#include "textslam/detect/text_detector.hpp"

#include <stdexcept>

#include "detectors/plugins.hpp"
#include "io/input_error.hpp"
#include "textslam/detect/classical_detector.hpp"

namespace textslam {
namespace {

class FileDetector final : public TextDetector {
 public:
  explicit FileDetector(const Sequence& sequence) : sequence_(sequence) {}
  std::vector<Detection> detect(const FrameRef& frame, ImageView8) override {
    return read_detections(sequence_, frame);
  }

 private:
  const Sequence& sequence_;
};

// Reads what another detector found and left unread.
class ReadingDetector final : public TextDetector {
 public:
  ReadingDetector(std::unique_ptr<TextDetector> detector, std::unique_ptr<TextReader> reader)
      : detector_(std::move(detector)), reader_(std::move(reader)) {}
  std::vector<Detection> detect(const FrameRef& frame, ImageView8 raw_image) override {
    std::vector<Detection> found = detector_->detect(frame, raw_image);
    for (Detection& detection : found) {
      if (is_read(detection.text)) continue;
      const TextReader::Reading reading = reader_->read(raw_image, detection.quad);
      if (!is_read(reading.text)) continue;
      detection.text = reading.text;
      detection.score = reading.score;
    }
    return found;
  }

 private:
  std::unique_ptr<TextDetector> detector_;
  std::unique_ptr<TextReader> reader_;
};

[[noreturn]] void refuse(const std::string& option, const std::string& switch_name, const std::string& package) {
  throw InputError(option, 0,
                   "this build lacks the plug-in; configure with -D" + switch_name + "=ON (Debian: " + package + ")");
}

std::unique_ptr<TextDetector> make_found(const DetectorOptions& options, const Sequence& sequence) {
  if (options.name == "files") return std::make_unique<FileDetector>(sequence);
  if (options.name == "classical") return std::make_unique<ClassicalDetector>();
  if (options.name == "dnn") {
    if (!kHasDnn) refuse("--detector dnn", "TEXTSLAM_DNN", "libopencv-dev");
    return make_dnn_detector(options.model);
  }
  if (options.name == "tesseract") {
    if (!kHasTesseract) refuse("--detector tesseract", "TEXTSLAM_TESSERACT", "libtesseract-dev tesseract-ocr-eng");
    return make_tesseract_detector();
  }
  std::string known;
  for (const std::string& name : detector_names()) known += (known.empty() ? "" : ", ") + name;
  throw std::invalid_argument("unknown detector '" + options.name + "'; known: " + known);
}

}  // namespace

const std::vector<std::string>& detector_names() {
  static const std::vector<std::string> names = {"files", "classical", "dnn", "tesseract"};
  return names;
}

std::unique_ptr<TextDetector> make_detector(const DetectorOptions& options, const Sequence& sequence) {
  std::unique_ptr<TextDetector> detector = make_found(options, sequence);
  if (options.name == "tesseract" && options.words == "auto") return detector;  // it reads itself
  std::unique_ptr<TextReader> reader = make_reader(options);
  if (!reader) return detector;
  return std::make_unique<ReadingDetector>(std::move(detector), std::move(reader));
}

std::unique_ptr<TextReader> make_reader(const DetectorOptions& options) {
  std::string reader = options.words;
  if (reader == "auto") {
    const bool by_network = options.name == "dnn" && (has_default_dnn_reader() || !options.words_model.empty());
    const bool by_tesseract = (options.name == "dnn" || options.name == "tesseract") && kHasTesseract;
    reader = by_network ? "dnn" : by_tesseract ? "tesseract" : "none";
  }
  if (reader == "none") return nullptr;
  if (reader == "dnn") {
    if (!kHasDnn) refuse("--words dnn", "TEXTSLAM_DNN", "libopencv-dev");
    return make_dnn_reader(options.words_model);
  }
  if (!kHasTesseract) refuse("--words tesseract", "TEXTSLAM_TESSERACT", "libtesseract-dev tesseract-ocr-eng");
  return make_tesseract_reader();
}

}  // namespace textslam
