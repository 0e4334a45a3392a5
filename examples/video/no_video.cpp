// In place of video_file.cpp in a build without the plug-in.
#include "io/video_file.hpp"

#include "io/input_error.hpp"

namespace textslam {

bool has_video() { return false; }

std::unique_ptr<VideoFile> open_video(const std::string& path) {
  throw InputError(path, 0,
                   "this is not a folder, and this build reads no videos; configure with -DTEXTSLAM_VIDEO=ON (Debian: "
                   "libavformat-dev libavcodec-dev libswscale-dev)");
}

}  // namespace textslam
