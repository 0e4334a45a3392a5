// ClassicalDetector: text quads without a model, from the image alone.
//
// On each level of a pyramid: ink (text_ink), letters by connected pieces of ink (text_letters), lines by letters side
// by side (text_lines), quads around lines (text_quads); then the best of those that overlap. It finds printed lines of
// three letters or more, at most 60 degrees from the horizontal, and reads nothing.
#ifndef TEXTSLAM_DETECTORS_CLASSICAL_DETECTOR_HPP
#define TEXTSLAM_DETECTORS_CLASSICAL_DETECTOR_HPP

#include <vector>

#include "detectors/classical_parameters.hpp"
#include "detectors/text_ink.hpp"
#include "detectors/text_letters.hpp"
#include "detectors/text_lines.hpp"
#include "detectors/text_quads.hpp"
#include "textplane/photometry/pyramid.hpp"
#include "textslam/detect/text_detector.hpp"

namespace textslam {

/// Keeps its memory between frames: use one a thread. The same image gives the same quads.
class ClassicalDetector final : public TextDetector {
 public:
  explicit ClassicalDetector(const ClassicalParameters& parameters = {}) : parameters_(parameters) {}

  /// Best first, text kUnreadText, score in (0, 1]. No quads in an invalid view. The frame itself is not used.
  std::vector<Detection> detect(const FrameRef& frame, ImageView8 raw_image) override;

 private:
  ClassicalParameters parameters_;
  textplane::Pyramid pyramid_;
  Image<std::uint8_t> ink_;
  InkScratch ink_scratch_;
  LetterScratch letter_scratch_;
  LineScratch line_scratch_;
  std::vector<Letter> letters_;
  std::vector<std::vector<int>> lines_;
  std::vector<TextQuad> quads_;
};

}  // namespace textslam

#endif  // TEXTSLAM_DETECTORS_CLASSICAL_DETECTOR_HPP
