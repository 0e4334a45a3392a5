#include "textslam/detect/text_detector.hpp"

#include <algorithm>
#include <stdexcept>

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

std::vector<DetectorPlugin>& detectors() {
  static std::vector<DetectorPlugin> plugins = {
      {"files",
       [](const DetectorOptions&, const Sequence& sequence) { return std::make_unique<FileDetector>(sequence); },
       {}},
      {"classical", [](const DetectorOptions&, const Sequence&) { return std::make_unique<ClassicalDetector>(); }, {}}};
  return plugins;
}

std::vector<ReaderPlugin>& readers() {
  static std::vector<ReaderPlugin> plugins;
  return plugins;
}

template <class Plugin>
std::vector<std::string> names(const std::vector<Plugin>& plugins) {
  std::vector<std::string> out;
  for (const Plugin& plugin : plugins) out.push_back(plugin.name);
  return out;
}

template <class Plugin>
Plugin* find(std::vector<Plugin>& plugins, const std::string& name) {
  const auto found = std::find_if(plugins.begin(), plugins.end(), [&](const Plugin& p) { return p.name == name; });
  return found == plugins.end() ? nullptr : &*found;
}

template <class Plugin>
Plugin& find(std::vector<Plugin>& plugins, const std::string& name, const char* kind) {
  if (Plugin* const found = find(plugins, name)) return *found;
  std::string known;
  for (const std::string& other : names(plugins)) known += (known.empty() ? "" : ", ") + other;
  throw std::invalid_argument("unknown " + std::string(kind) + " '" + name + "'; known: " + known);
}

template <class Plugin>
void add(std::vector<Plugin>& plugins, Plugin plugin) {
  if (Plugin* const same = find(plugins, plugin.name)) {
    *same = std::move(plugin);
  } else {
    plugins.push_back(std::move(plugin));
  }
}

// The reader of --words auto; "none" where nobody reads.
std::string chosen_reader(const DetectorOptions& options) {
  for (const std::string& name : find(detectors(), options.name, "detector").readers) {
    const ReaderPlugin* const reader = find(readers(), name);
    if (reader != nullptr && (!reader->ready || reader->ready(options))) return name;
  }
  return "none";
}

}  // namespace

void register_detector(DetectorPlugin plugin) { add(detectors(), std::move(plugin)); }
void register_reader(ReaderPlugin plugin) { add(readers(), std::move(plugin)); }

void register_missing(const std::string& name, const std::string& option, const std::string& packages) {
  const std::string how = "this build lacks the plug-in; configure with -D" + option + "=ON (Debian: " + packages + ")";
  register_detector({name,
                     [=](const DetectorOptions&, const Sequence&) -> std::unique_ptr<TextDetector> {
                       throw InputError("--detector " + name, 0, how);
                     },
                     {}});
  register_reader(
      {name,
       [=](const DetectorOptions&) -> std::unique_ptr<TextReader> { throw InputError("--words " + name, 0, how); },
       [](const DetectorOptions&) { return false; }});
}

std::vector<std::string> detector_names() { return names(detectors()); }
std::vector<std::string> reader_names() { return names(readers()); }

std::unique_ptr<TextDetector> make_detector(const DetectorOptions& options, const Sequence& sequence) {
  const DetectorPlugin& plugin = find(detectors(), options.name, "detector");
  std::unique_ptr<TextDetector> detector = plugin.make(options, sequence);
  if (plugin.reads && options.words == "auto") return detector;
  std::unique_ptr<TextReader> reader = make_reader(options);
  if (!reader) return detector;
  return std::make_unique<ReadingDetector>(std::move(detector), std::move(reader));
}

std::unique_ptr<TextReader> make_reader(const DetectorOptions& options) {
  const std::string name = options.words == "auto" ? chosen_reader(options) : options.words;
  return name == "none" ? nullptr : find(readers(), name, "reader").make(options);
}

}  // namespace textslam
