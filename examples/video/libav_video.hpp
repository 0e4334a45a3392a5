// Video files by libav: libavformat, libavcodec and libswscale.
#ifndef TEXTSLAM_VIDEO_LIBAV_VIDEO_HPP
#define TEXTSLAM_VIDEO_LIBAV_VIDEO_HPP

#include "io/video_file.hpp"

namespace textslam {

std::unique_ptr<VideoFile> open_libav_video(const std::string& path);

}  // namespace textslam

#endif  // TEXTSLAM_VIDEO_LIBAV_VIDEO_HPP
