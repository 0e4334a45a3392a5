// TextDetector: where a frame's text quads come from. Everything else in the system is the same for all of them.
// How to write one: docs/detectors.md.
#ifndef TEXTSLAM_DETECT_TEXT_DETECTOR_HPP
#define TEXTSLAM_DETECT_TEXT_DETECTOR_HPP

#include <memory>
#include <string>
#include <vector>

#include "io/detections.hpp"
#include "io/sequence.hpp"

namespace textslam {

class TextDetector {
 public:
  virtual ~TextDetector() = default;
  /// Quads in raw image pixels, clockwise from the text's top left. May throw InputError. Called by one thread at a
  /// time, not always the one that made it.
  virtual std::vector<Detection> detect(const FrameRef& frame, ImageView8 raw_image) = 0;
};

/// Reads the text of a quad that another detector found.
class TextReader {
 public:
  virtual ~TextReader() = default;
  struct Reading {
    std::string text = kUnreadText;
    double score = 0;  ///< 0 to 1.
  };
  virtual Reading read(ImageView8 raw_image, const Quad<double>& quad) = 0;
};

struct DetectorOptions {
  std::string name = "files";  ///< One of detector_names().
  std::string model;           ///< Of `dnn`; empty: where scripts/get-detector puts it.
  std::string words = "auto";  ///< Who reads: "none", "dnn", "tesseract", or "auto", see make_reader().
  std::string words_model;     ///< Of the reader `dnn`; empty: where scripts/get-detector --reader puts it.
};

/// "files" (the sequence's own detections, by any external detector), "classical" (built in, no model), "dnn" (a
/// network through OpenCV) and "tesseract"; the last two are plug-ins that a build may lack.
const std::vector<std::string>& detector_names();

/// The sequence must outlive the detector. Throws InputError where the plug-in was not built, saying how to build it,
/// and for a model that is missing or wrong; std::invalid_argument that lists the names for any other name.
std::unique_ptr<TextDetector> make_detector(const DetectorOptions& options, const Sequence& sequence);

/// Who reads what is unread, and the texts of the map; null: nobody. "auto": after `dnn` the recogniser, where its
/// model is, else Tesseract where it was built; after `tesseract` that; else nobody. Throws InputError as
/// make_detector() does.
std::unique_ptr<TextReader> make_reader(const DetectorOptions& options);

}  // namespace textslam

#endif  // TEXTSLAM_DETECT_TEXT_DETECTOR_HPP
