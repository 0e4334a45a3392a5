// 05: follows a planar object through a video from its corners in the first frame (planar/plane_tracker.hpp).
//
//   05_track_a_plane FOLDER x1,y1,x2,y2,x3,y3,x4,y4 CORNERS.csv
//
// FOLDER: images of one size, in the order of their names. The corners are clockwise from the top left. CORNERS.csv
// receives a line for each frame: the corners and their ZNCC with the first frame, or the frame alone where the object
// was not found. Without arguments the program renders a video and tracks that.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <vector>

#include "io/image_file.hpp"
#include "io/input_error.hpp"
#include "io/output_file.hpp"
#include "planar/plane_tracker.hpp"
#include "stage/picture.hpp"
#include "stage/stage.hpp"

using namespace textslam;

int track_video(const std::string& folder, const char* corners, const std::string& output) {
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) files.push_back(entry.path().string());
  std::sort(files.begin(), files.end());
  if (files.empty()) throw InputError(folder, 0, "no images");
  Quad<double> quad;
  auto& c = quad.corner;
  if (std::sscanf(corners, "%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf", &c[0][0], &c[0][1], &c[1][0], &c[1][1], &c[2][0],
                  &c[2][1], &c[3][0], &c[3][1]) != 8)
    throw InputError(corners, 0, "not eight numbers with commas");
  planar::PlaneTracker tracker(load_grey(files[0]).view(), quad);
  if (!textplane::is_ok(tracker.status())) throw InputError(files[0], 0, textplane::to_string(tracker.status()));

  std::string lines = "frame,zncc,x1,y1,x2,y2,x3,y3,x4,y4\n";
  std::size_t found = 0;
  for (const std::string& file : files) {
    lines += std::filesystem::path(file).stem().string();
    if (textplane::is_ok(tracker.track(load_grey(file).view()))) {
      ++found;
      lines += "," + std::to_string(tracker.zncc());
      for (const auto& corner : tracker.quad().corner)
        lines += "," + std::to_string(corner[0]) + "," + std::to_string(corner[1]);
    }
    lines += "\n";
  }
  write_file(output, lines);
  std::printf("found in %zu of %zu frames\n", found, files.size());
  return 0;
}

int main(int argc, char** argv) try {
  if (argc == 4) return track_video(argv[1], argv[2], argv[3]);
  const Stage stage("EXIT 24", {0.1, -0.2, 0.0});
  const auto camera = [](double s) {
    return camera_at({0.4 * s, -0.2 * s * s, 0.4 * s}, {0.1 * s, -0.25 * s, 0.4 * s});
  };
  const Image<std::uint8_t> first = stage.view(camera(0));
  planar::PlaneTracker tracker(first.view(), stage.quad(camera(0)));
  Picture picture(argc, argv);
  picture.panel(first.view(), "frame 0").quad(stage.quad(camera(0)), kTruth);
  double worst = 0;
  for (int i = 1; i <= 30; ++i) {
    const SE3d T_w_c = camera(i / 30.0);
    const Image<std::uint8_t> image = stage.view(T_w_c);
    if (!textplane::is_ok(tracker.track(image.view()))) return 1;
    worst = std::max(worst, corner_error(tracker.quad(), stage.quad(T_w_c)));
    if (i % 15 == 0) picture.panel(image.view(), "frame " + std::to_string(i)).quad(tracker.quad(), kFound);
  }
  std::printf("worst of 30 frames: corners off by %.3f px\n", worst);
  picture.save();
  return 0;
} catch (const std::exception& error) {  // a file that cannot be read or written, by name
  std::fprintf(stderr, "%s\n", error.what());
  return 2;
}
