#include "io/video_file.hpp"

#include "io/input_error.hpp"

namespace textslam {
namespace {

VideoOpener& opener() {
  static VideoOpener open = nullptr;
  return open;
}

}  // namespace

void register_video(VideoOpener open) { opener() = open; }

bool has_video() { return opener() != nullptr; }

std::unique_ptr<VideoFile> open_video(const std::string& path) {
  if (has_video()) return opener()(path);
  throw InputError(path, 0,
                   "this is not a folder, and this build reads no videos; configure with -DTEXTSLAM_VIDEO=ON (Debian: "
                   "libavformat-dev libavcodec-dev libswscale-dev)");
}

}  // namespace textslam
