#include "textslam/detect/text_detector.hpp"

#include <algorithm>
#include <stdexcept>

#include "io/input_error.hpp"
#include "textslam/common/algorithms.hpp"
#include "textslam/detect/rectified_view.hpp"
#include "textslam/input/sequence_camera.hpp"

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

// What detectors and readers see of the images of a lens that bends lines.
struct Straightened {
  explicit Straightened(const CameraModel& model) : camera(model), view(camera.view(), model.width, model.height) {}
  SequenceCamera camera;
  RectifiedView view;
};

// Null where the lens bends lines by little.
std::shared_ptr<const Straightened> straightened(const CameraModel& camera) {
  if (!(line_bend(SequenceCamera(camera).view(), camera.width, camera.height) > kMostBend)) return nullptr;
  return std::make_shared<const Straightened>(camera);
}

// Reads what another detector found and left unread.
class ReadingDetector final : public TextDetector {
 public:
  ReadingDetector(std::unique_ptr<TextDetector> detector, std::unique_ptr<TextReader> reader,
                  std::shared_ptr<const Straightened> lens)
      : detector_(std::move(detector)), reader_(std::move(reader)), lens_(std::move(lens)) {}
  bool wants_colour() const override { return detector_->wants_colour(); }
  std::vector<Detection> detect(const FrameRef& frame, ImageView8 raw_image) override {
    std::vector<Detection> found = detector_->detect(frame, raw_image);
    const auto unread = [](const Detection& detection) { return !is_read(detection.text); };
    Image<std::uint8_t> straight;
    if (lens_ && std::any_of(found.begin(), found.end(), unread)) straight = lens_->view(raw_image);
    for (Detection& detection : found) {
      if (!unread(detection)) continue;
      Quad<double> quad = detection.quad;
      const bool in_view = lens_ && lens_->view.from_image(&quad);
      const TextReader::Reading reading = reader_->read(in_view ? straight.view() : raw_image, quad);
      if (!is_read(reading.text)) continue;
      detection.text = reading.text;
      detection.score = reading.score;
    }
    return found;
  }

 private:
  std::unique_ptr<TextDetector> detector_;
  std::unique_ptr<TextReader> reader_;
  std::shared_ptr<const Straightened> lens_;
};

// Shows another detector the middle of images whose lens bends lines.
class RectifyingDetector final : public TextDetector {
 public:
  RectifyingDetector(std::unique_ptr<TextDetector> detector, std::shared_ptr<const Straightened> lens)
      : detector_(std::move(detector)), lens_(std::move(lens)) {}
  bool wants_colour() const override { return detector_->wants_colour(); }
  std::vector<Detection> detect(const FrameRef& frame, ImageView8 raw_image) override {
    FrameRef seen = frame;
    seen.path.clear();  // what the file shows is bent
    if (frame.colour.width() == 3 * raw_image.width()) seen.colour = lens_->view(frame.colour.view(), 3);
    const Image<std::uint8_t> image = lens_->view(raw_image);
    std::vector<Detection> found = detector_->detect(seen, image.view());
    erase_if(found, [&](Detection& detection) { return !lens_->view.to_image(&detection.quad); });
    return found;
  }

 private:
  std::unique_ptr<TextDetector> detector_;
  std::shared_ptr<const Straightened> lens_;
};

std::vector<TextPlugin>& plugins() {
  static std::vector<TextPlugin> all = {
      {"files", [](auto&, const Sequence& s) { return std::make_unique<FileDetector>(s); }, nullptr}};
  return all;
}

auto find(const std::string& name) {
  return std::find_if(plugins().begin(), plugins().end(), [&](const TextPlugin& p) { return p.name == name; });
}

// The names of all that have a detector, or a reader.
template <class Member>
std::vector<std::string> names(Member member) {
  std::vector<std::string> out;
  for (const TextPlugin& plugin : plugins())
    if (plugin.*member) out.push_back(plugin.name);
  return out;
}

template <class Member>
const TextPlugin& plugin_with(Member member, const std::string& name, const char* kind) {
  const auto found = find(name);
  if (found != plugins().end() && *found.*member) return *found;
  std::string known;
  for (const std::string& other : names(member)) known += (known.empty() ? "" : ", ") + other;
  throw std::invalid_argument("unknown " + std::string(kind) + " '" + name + "'; known: " + known);
}

// The reader of --words auto.
std::string chosen_reader(const DetectorOptions& options) {
  for (const std::string& name : plugin_with(&TextPlugin::detector, options.name, "detector").readers)
    if (find(name) != plugins().end() && find(name)->ready(options)) return name;
  return "none";
}

}  // namespace

TextPlugin missing_plugin(const std::string& name, const std::string& option, const std::string& packages) {
  const auto refuse = [=](const char* asked) {
    return InputError(asked + name, 0,
                      "this build lacks the plug-in; configure with -D" + option + "=ON (Debian: " + packages + ")");
  };
  return {name, [=](auto&...) -> std::unique_ptr<TextDetector> { throw refuse("--detector "); },
          [=](auto&) -> std::unique_ptr<TextReader> { throw refuse("--words "); },
          [](const DetectorOptions&) { return false; }};
}

void register_plugin(TextPlugin plugin) {
  erase_if(plugins(), [&](const TextPlugin& other) { return other.name == plugin.name; });
  plugins().push_back(std::move(plugin));
}

std::vector<std::string> detector_names() { return names(&TextPlugin::detector); }
std::vector<std::string> reader_names() { return names(&TextPlugin::reader); }

std::unique_ptr<TextDetector> make_detector(const DetectorOptions& options, const Sequence& sequence) {
  const TextPlugin& plugin = plugin_with(&TextPlugin::detector, options.name, "detector");
  std::unique_ptr<TextDetector> detector = plugin.detector(options, sequence);
  const std::shared_ptr<const Straightened> lens = straightened(sequence.camera);
  if (lens && plugin.name != "files") detector = std::make_unique<RectifyingDetector>(std::move(detector), lens);
  if (plugin.reads && options.words == "auto") return detector;
  std::unique_ptr<TextReader> reader = make_reader(options);
  if (!reader) return detector;
  return std::make_unique<ReadingDetector>(std::move(detector), std::move(reader), lens);
}

std::unique_ptr<TextReader> make_reader(const DetectorOptions& options) {
  const std::string name = options.words == "auto" ? chosen_reader(options) : options.words;
  return name == "none" ? nullptr : plugin_with(&TextPlugin::reader, name, "reader").reader(options);
}

}  // namespace textslam
