// Detections against the true quads of a frame, by their overlap.
//
// Truth: truth/quads/<stem>.txt in the folder of a rendered sequence (renderer/render_sequence.hpp), where a sign
// counts if it is wholly in view and at least kMinHeight px high; or gt_<stem>.txt of ICDAR beside the image, where a
// text counts unless it is `###`. A text that does not count is neither missed nor false.
#ifndef TEXTSLAM_IO_EVALUATE_DETECTIONS_HPP
#define TEXTSLAM_IO_EVALUATE_DETECTIONS_HPP

#include <string>
#include <vector>

#include "io/detections.hpp"

namespace textslam {

struct TrueText {
  Quad<double> quad;  ///< Raw px.
  bool counts = true;
};

struct DetectionCounts {
  int frames = 0;
  int texts = 0;  ///< Texts that count.
  int found = 0;  ///< Texts that their detection overlaps by kMinOverlap.
  int boxes = 0;  ///< Detections, without those of which more than half lies on a text that does not count.

  double recall() const { return texts > 0 ? static_cast<double>(found) / texts : 0; }
  double precision() const { return boxes > 0 ? static_cast<double>(found) / boxes : 0; }
};

constexpr double kMinOverlap = 0.5;  ///< IoU.
constexpr double kMinHeight = 10;    ///< px, the shorter of a sign's left and right edges.

/// Throws InputError where the frame has no truth, and with the line for a broken file.
std::vector<TrueText> read_true_texts(const Sequence& sequence, const FrameRef& frame);

/// Adds a frame: pairs each text with at most one detection, the largest overlaps first.
void count_detections(const std::vector<TrueText>& truth, const std::vector<Detection>& found, DetectionCounts* counts);

/// `200 frames, 812 texts, 640 found, 700 boxes: recall 0.788, precision 0.914`.
std::string format_counts(const DetectionCounts& counts);

}  // namespace textslam

#endif  // TEXTSLAM_IO_EVALUATE_DETECTIONS_HPP
