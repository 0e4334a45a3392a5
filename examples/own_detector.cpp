// A text detector of your own: textslam with a detector that keeps the large texts of the built-in one, as distant text
// blurs first. Replace it with any code that makes quads of an image: docs/detectors.md.
#include <cstdio>

#include "detectors/classical_detector.hpp"
#include "io/input_error.hpp"
#include "plugins/plugins.hpp"
#include "textplane/geometry/quad.hpp"
#include "textslam/run.hpp"

using namespace textslam;

class LargeTextDetector final : public TextDetector {
 public:
  explicit LargeTextDetector(double smallest_area) : smallest_area_(smallest_area) {}

  // Quads in pixels of the raw image, clockwise from the text's top left, with text and score where known.
  std::vector<Detection> detect(const FrameRef& frame, ImageView8 raw_image) override {
    std::vector<Detection> large;
    for (const Detection& found : classical_.detect(frame, raw_image))
      if (textplane::area(found.quad) >= smallest_area_) large.push_back(found);
    return large;
  }

 private:
  ClassicalDetector classical_;
  double smallest_area_;  // px^2
};

int main(int argc, char** argv) try {
  if (argc != 3) return std::fprintf(stderr, "usage: own_detector SEQUENCE OUTPUT\n"), 2;
  register_plugins();  // of them, here, the reader of video files
  RunOptions options;
  options.sequence = argv[1];
  options.output = argv[2];
  options.own_detector = std::make_shared<LargeTextDetector>(600);
  const RunResult result = run(options);
  std::printf("texts mapped: %zu\nreport: %s\n", result.summary.texts, result.report.c_str());
  return result.error.empty() ? 0 : 1;
} catch (const std::exception& e) {
  return std::fprintf(stderr, "own_detector: %s\n", e.what()), 2;
}
