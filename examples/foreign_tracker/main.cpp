// foreign_tracker SEQUENCE OUTPUT [--text]: runs the tracker on a sequence (examples/io/sequence.hpp), without or with
// text features. Writes OUTPUT/trajectory.txt (TUM), and prints its error where the truth is known.
#include <cstdio>
#include <cstring>
#include <exception>
#include <string>

#include "foreign_tracker/tracker.hpp"
#include "io/detections.hpp"  // text
#include "io/evaluate.hpp"
#include "io/image_file.hpp"
#include "io/output_file.hpp"
#include "io/sequence.hpp"

int main(int argc, char** argv) try {
  const bool with_text = argc == 4 && std::strcmp(argv[3], "--text") == 0;  // text
  if (argc != 3 && !with_text) return std::fprintf(stderr, "usage: foreign_tracker SEQUENCE OUTPUT [--text]\n"), 2;
  const textslam::Sequence sequence = textslam::read_sequence(argv[1]);
  textslam::create_output_folder(argv[2]);
  const int width = sequence.camera.width, height = sequence.camera.height;
  const textslam::Pinhole<double>& pinhole = sequence.camera.pinhole();
  cv::setRNGSeed(1);
  const foreign::Camera camera{pinhole.fx, pinhole.fy, pinhole.cx, pinhole.cy, width, height};
  foreign::Tracker tracker(camera);
  for (std::size_t i = 0; i < sequence.frames.size(); ++i) {
    auto pixels = textslam::load_frame(sequence, i);
    foreign::Frame frame;
    frame.time = sequence.frames[i].timestamp;
    frame.image = cv::Mat(height, width, CV_8UC1, pixels.data()).clone();
    for (const auto& found : textslam::read_detections(sequence, sequence.frames[i]))  // text
      if (with_text) frame.quads.emplace_back(found.quad, found.text, found.score);    // text
    tracker.grab(std::move(frame));
  }
  std::vector<textslam::StampedPose> poses;
  for (const auto& [time, T] : tracker.trajectory()) poses.push_back({time, {T.rotationMatrix(), T.translation()}});
  textslam::write_tum(std::string(argv[2]) + "/trajectory.txt", poses);
  const auto found = textslam::evaluate_trajectory(poses, sequence.groundtruth, sequence.frames.size());
  std::printf("frames with a pose %zu of %zu\nkey frames %zu\n", poses.size(), sequence.frames.size(),
              tracker.map().key_frames.size());
  if (textplane::is_ok(found.status)) std::printf("ATE rmse %.2f mm\n", 1000 * found.ate.rmse);
  return 0;
} catch (const std::exception& error) {
  return std::fprintf(stderr, "foreign_tracker: %s\n", error.what()), 2;
}
