// The options of an input on the command line, the same for every program that has one. Needs CLI11.
#ifndef TEXTSLAM_CLI_SEQUENCE_OPTIONS_HPP
#define TEXTSLAM_CLI_SEQUENCE_OPTIONS_HPP

#include <CLI/CLI.hpp>

#include "cli/command_line.hpp"
#include "io/sequence.hpp"

namespace textslam {

constexpr const char* kSequenceHelp =
    "Folder with images.txt (or rgb.txt) and camera.yaml, optionally detections/ and groundtruth.txt; or in EuRoC's "
    "layout (mav0); or of images; or a video";

// The angle of a camera_from_fov() that is a lens for images of planes; beyond it nothing is a pinhole.
constexpr double kLeastFov = 1, kLargestFov = 170;
constexpr double kLeastFps = 1e-3, kLargestFps = 1e5;

inline void add_sequence_options(CLI::App& app, SequenceOptions& options) {
  CLI::Option* camera =
      app.add_option("--camera", options.camera,
                     "Camera file of ORB-SLAM, EuRoC, kalibr, OpenCV or COLMAP, in place of the sequence's own");
  app.add_option("--fov", options.fov,
                 "Horizontal field of view, degrees, where there is no calibration, else it is refused; the camera is "
                 "approximate")
      ->check(within(kLeastFov, kLargestFov))
      ->excludes(camera);
  app.add_option("--fps", options.fps,
                 "Of a folder of images, frames a second; by default what its camera.yaml says, or 30")
      ->check(within(kLeastFps, kLargestFps));
  app.add_option("--detections", options.detections,
                 "Folder with a file of text boxes an image (ICDAR), in place of the sequence's own");
}

}  // namespace textslam

#endif  // TEXTSLAM_CLI_SEQUENCE_OPTIONS_HPP
