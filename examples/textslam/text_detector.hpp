// TextDetector: where a frame's text quads come from. Everything else in the system is the same for all of them.
#ifndef TEXTSLAM_TEXT_DETECTOR_HPP
#define TEXTSLAM_TEXT_DETECTOR_HPP

#include <memory>
#include <string>
#include <vector>

#include "io/detections.hpp"
#include "io/sequence.hpp"

namespace textslam {

class TextDetector {
 public:
  virtual ~TextDetector() = default;
  /// Quads in raw image pixels, clockwise from the text's top left. May throw InputError.
  virtual std::vector<Detection> detect(const FrameRef& frame, ImageView8 raw_image) = 0;
};

/// `name`: "files" (the sequence's own detections, by any external detector) or "classical" (built in, no model).
/// The sequence must outlive the detector. Throws std::invalid_argument that lists the names for any other.
std::unique_ptr<TextDetector> make_detector(const std::string& name, const Sequence& sequence);

}  // namespace textslam

#endif  // TEXTSLAM_TEXT_DETECTOR_HPP
