// The commands of textslam-map that look for text in images: find and import. Need CLI11 and the plug-ins.
#ifndef TEXTSLAM_MAP_IMAGE_COMMANDS_HPP
#define TEXTSLAM_MAP_IMAGE_COMMANDS_HPP

#include <CLI/CLI.hpp>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "cli/detector_options.hpp"
#include "io/image_file.hpp"
#include "io/input_error.hpp"
#include "textslam_map/find_image.hpp"
#include "textslam_map/image_detections.hpp"
#include "textslam_map/import_colmap.hpp"

namespace textslam {

/// Where was each image taken? Exit code 1 where one was not found.
class FindCommand {
 public:
  explicit FindCommand(CLI::App& app) {
    command_ = app.add_subcommand("find",
                                  "Where was each image taken? Camera, direction and what it was found by; exit code 1 "
                                  "where not all were");
    command_->add_option("FILE", file_, "Map file")->required();
    command_->add_option("IMAGE", images_, "Images of the map's camera")->required();
    command_->add_option("--detections", detections_,
                         "Of --detector files: their folder, if it is not `detections` beside the images");
    command_->add_flag("--json", json_, "Print it as JSON");
    add_detector_options(*command_, detector_);
  }
  bool parsed() const { return command_->parsed(); }
  int run() {
    const LoadedMap map = load_map(file_, {});
    const CameraModel& camera = map.record.camera;
    ImageFinder finder(map);
    ImageDetections detections(detector_, camera, detections_);
    std::vector<ImageAnswer> answers;
    bool all = true;
    for (const std::string& path : images_) {
      Image<std::uint8_t> image = load_grey(path);
      check_size(path, image.view(), camera, "the map's images are");
      std::vector<Detection> seen = detections.of(path, image.view());
      answers.push_back(finder.find(std::move(image), std::move(seen)));
      answers.back().image = path;
      all = all && answers.back().by != FoundBy::nothing;
      if (!json_) std::printf("%s", answer_text(answers.back()).c_str());
    }
    if (json_) std::printf("%s", answers_json(answers).c_str());
    return all ? 0 : 1;
  }

 private:
  CLI::App* command_ = nullptr;
  std::string file_, detections_;
  std::vector<std::string> images_;
  DetectorOptions detector_;
  bool json_ = false;
};

/// A map file of a model of COLMAP.
class ImportCommand {
 public:
  explicit ImportCommand(CLI::App& app) {
    command_ = app.add_subcommand(
        "import", "Make a map file of a model of COLMAP, of one camera, with the texts that are found in its images");
    command_->add_option("MODEL", model_, "Folder of cameras, images and points3D, .bin or .txt")->required();
    command_->add_option("--images", images_, "Folder of the images that the model names")->required();
    command_->add_option("--output", output_, "Map file to write; one that is there is replaced")->required();
    command_->add_option("--detections", detections_,
                         "Of --detector files: their folder, if it is not `detections` beside the images");
    add_detector_options(*command_, detector_);
  }
  bool parsed() const { return command_->parsed(); }
  int run() const {
    check_can_save(output_);
    const ColmapScene scene = read_colmap_scene(model_);
    if (scene.images.size() < 2) throw InputError(model_, 0, "the model has fewer than two images");
    const CameraModel camera = camera_of(scene, model_);
    ImageDetections detections(detector_, camera, detections_);
    LoadedMap map = import_colmap(scene, camera, images_, detections);
    save_map(output_, map.map, map.record);
    std::printf("%s", imported_text(map).c_str());
    return 0;
  }

 private:
  CLI::App* command_ = nullptr;
  std::string model_, images_, output_, detections_;
  DetectorOptions detector_;
};

}  // namespace textslam

#endif  // TEXTSLAM_MAP_IMAGE_COMMANDS_HPP
