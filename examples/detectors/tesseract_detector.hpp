// Text by Tesseract: quads with words from a whole image, and the words of quads that another detector found.
//
// A word needs min_confidence and at least two letters or digits: what Tesseract reads in texture is short and
// uncertain.
#ifndef TEXTSLAM_DETECTORS_TESSERACT_DETECTOR_HPP
#define TEXTSLAM_DETECTORS_TESSERACT_DETECTOR_HPP

#include <memory>
#include <string>
#include <vector>

#include "textslam/detect/text_detector.hpp"

namespace tesseract {
class TessBaseAPI;
}

namespace textslam {

struct TesseractParameters {
  std::string language = "eng";
  double min_confidence = 0.5;  ///< 0 to 1, of a word.
  double zoom = 2;              ///< Of a whole image: Tesseract wants letters of 20 px and more.
  int line_height = 40;         ///< px that a quad is read at.
  double line_margin = 0.1;     ///< Of its height, around the quad.
};

class Tesseract final : public TextDetector, public TextReader {
 public:
  /// Throws InputError where there is no data for the language.
  explicit Tesseract(const TesseractParameters& parameters = {});
  ~Tesseract() override;

  /// Words along their base lines, score Tesseract's confidence. The frame itself is not used.
  std::vector<Detection> detect(const FrameRef& frame, ImageView8 raw_image) override;
  /// The quad's text as one line, from its top left; the score is the mean confidence of its words.
  Reading read(ImageView8 raw_image, const Quad<double>& quad) override;

 private:
  TesseractParameters parameters_;
  std::unique_ptr<tesseract::TessBaseAPI> api_;
};

/// Throw InputError where Tesseract has no data for the language.
std::unique_ptr<TextDetector> make_tesseract_detector(const DetectorOptions& options, const Sequence& sequence);
std::unique_ptr<TextReader> make_tesseract_reader(const DetectorOptions& options);
inline bool is_tesseract_ready(const DetectorOptions&) { return true; }

}  // namespace textslam

#endif  // TEXTSLAM_DETECTORS_TESSERACT_DETECTOR_HPP
