// The command `find` of textslam-map. Needs CLI11 and the plug-ins.
#ifndef TEXTSLAM_MAP_FIND_COMMAND_HPP
#define TEXTSLAM_MAP_FIND_COMMAND_HPP

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "cli/detector_options.hpp"
#include "io/image_file.hpp"
#include "io/input_error.hpp"
#include "textslam/detect/text_detector.hpp"
#include "textslam_map/find_image.hpp"

namespace textslam {

/// Where was each image taken? Exit code 1 where one was not found.
class FindCommand {
 public:
  explicit FindCommand(CLI::App& app) {
    command_ = app.add_subcommand(
        "find",
        "Where was each image taken? Camera, direction and what it was found by; exit code 1 where not all were");
    command_->add_option("FILE", file_, "Map file")->required();
    command_->add_option("IMAGE", images_, "Images of the map's camera")->required();
    command_->add_option("--detections", detections_,
                         "Of --detector files: their folder, if they are not beside the images");
    command_->add_flag("--json", json_, "Print it as JSON");
    add_detector_options(*command_, detector_);
  }
  bool parsed() const { return command_->parsed(); }
  int run() {
    const LoadedMap map = load_map(file_, {});
    ImageFinder finder(map);
    Sequence sequence;  // of one image at a time
    sequence.camera = map.record.camera;
    sequence.detections = detections_;
    const std::unique_ptr<TextDetector> detector = make_detector(detector_, sequence);
    std::vector<ImageAnswer> answers;
    bool all = true;
    for (const std::string& path : images_) {
      Image<std::uint8_t> image = load_grey(path);
      const CameraModel& camera = map.record.camera;
      if (image.width() != camera.width || image.height() != camera.height)
        throw InputError(path, 0,
                         "the map's images are " + std::to_string(camera.width) + " x " +
                             std::to_string(camera.height) + ", this one is not");
      take(path, &sequence);
      std::vector<Detection> seen = detector->detect(sequence.frames.front(), image.view());
      answers.push_back(finder.find(std::move(image), std::move(seen)));
      answers.back().image = path;
      all = all && answers.back().by != FoundBy::nothing;
      if (!json_) std::printf("%s", answer_text(answers.back()).c_str());
    }
    if (json_) std::printf("%s", answers_json(answers).c_str());
    return all ? 0 : 1;
  }

 private:
  static void take(const std::string& path, Sequence* sequence) {
    const std::filesystem::path file(path);
    sequence->folder = file.has_parent_path() ? file.parent_path().string() : ".";
    FrameRef frame;
    frame.path = path;
    frame.stem = file.stem().string();
    sequence->frames = {frame};
  }

  CLI::App* command_ = nullptr;
  std::string file_, detections_;
  std::vector<std::string> images_;
  DetectorOptions detector_;
  bool json_ = false;
};

}  // namespace textslam

#endif  // TEXTSLAM_MAP_FIND_COMMAND_HPP
