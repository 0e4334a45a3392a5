#include "textslam/text_detector.hpp"

#include <stdexcept>

#include "textslam/classical_detector.hpp"

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

}  // namespace

std::unique_ptr<TextDetector> make_detector(const std::string& name, const Sequence& sequence) {
  if (name == "files") return std::make_unique<FileDetector>(sequence);
  if (name == "classical") return std::make_unique<ClassicalDetector>();
  throw std::invalid_argument("unknown detector '" + name + "'; known: files, classical");
}

}  // namespace textslam
