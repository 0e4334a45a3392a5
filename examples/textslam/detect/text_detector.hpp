// TextDetector: where a frame's text quads come from. Everything else in the system is the same for all of them.
// How to write one: docs/detectors.md.
#ifndef TEXTSLAM_DETECT_TEXT_DETECTOR_HPP
#define TEXTSLAM_DETECT_TEXT_DETECTOR_HPP

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "io/detections.hpp"
#include "io/sequence.hpp"

namespace textslam {

class TextDetector {
 public:
  virtual ~TextDetector() = default;
  /// Whether frames of a video should bring their colours: FrameRef::colour. Files have theirs.
  virtual bool wants_colour() const { return false; }
  /// Quads in pixels of the image, clockwise from the text's top left. May throw InputError. Called by one thread at a
  /// time, not always the one that made it. The image is the frame's as it was taken, or where the lens bends lines of
  /// text the view of it that make_detector() says.
  virtual std::vector<Detection> detect(const FrameRef& frame, ImageView8 image) = 0;
};

/// Reads the text of a quad that another detector found.
class TextReader {
 public:
  virtual ~TextReader() = default;
  struct Reading {
    std::string text = kUnreadText;
    double score = 0;  ///< 0 to 1.
  };
  virtual Reading read(ImageView8 image, const Quad<double>& quad) = 0;
};

struct DetectorOptions {
  std::string name = "files";  ///< One of detector_names().
  std::string model;           ///< Of `dnn`; empty: where scripts/get-detector puts it.
  std::string words = "auto";  ///< Who reads: "none", one of reader_names(), or "auto", see make_reader().
  std::string words_model;     ///< Of the reader `dnn`; empty: where scripts/get-detector --reader puts it.
};

/// What detects or reads text, by its name for --detector and --words. "files" (the sequence's own detections, by any
/// external detector) is always there; main() registers the others: examples/plugins.
struct TextPlugin {
  std::string name;
  std::function<std::unique_ptr<TextDetector>(const DetectorOptions&, const Sequence&)> detector;
  std::function<std::unique_ptr<TextReader>(const DetectorOptions&)> reader;
  /// Whether --words auto may choose its reader.
  std::function<bool(const DetectorOptions&)> ready = [](const DetectorOptions&) { return true; };
  std::vector<std::string> readers = {};  ///< --words auto: the first of them that is ready reads after this detector.
  bool reads = false;                     ///< --words auto: its own detections are read as they come.
};
/// A plug-in that was not built: asking for it throws InputError with CMake's `option` and Debian's `packages`.
TextPlugin missing_plugin(const std::string& name, const std::string& option, const std::string& packages);
/// Replaces one of the same name. Not beside other threads.
void register_plugin(TextPlugin plugin);

std::vector<std::string> detector_names();
std::vector<std::string> reader_names();

/// The sequence must outlive the detector. Where its lens bends lines (rectified_view.hpp), all but "files", and
/// readers, look at the middle of the image rectified, in grey unless the frame brings its colours; quads come back
/// through the lens. Throws InputError where the plug-in was not built, and for a model that is
/// missing or wrong; std::invalid_argument that lists the names for any other name.
std::unique_ptr<TextDetector> make_detector(const DetectorOptions& options, const Sequence& sequence);

/// Who reads what is unread, and the texts of the map; null: nobody. Throws as make_detector().
std::unique_ptr<TextReader> make_reader(const DetectorOptions& options);

}  // namespace textslam

#endif  // TEXTSLAM_DETECT_TEXT_DETECTOR_HPP
