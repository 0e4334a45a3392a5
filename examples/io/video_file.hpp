// A video file as a source of frames. The reader is a plug-in (examples/video, -DTEXTSLAM_VIDEO=ON) on libavformat, libavcodec and
// libswscale; a build without it says how to get it.
#ifndef TEXTSLAM_IO_VIDEO_FILE_HPP
#define TEXTSLAM_IO_VIDEO_FILE_HPP

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "io/names.hpp"

namespace textslam {

/// The frames of a video, by their number. Not for several threads at a time.
class VideoFile {
 public:
  virtual ~VideoFile() = default;
  /// Seconds from the first frame, strictly increasing; one a frame, at least one.
  virtual const std::vector<double>& times() const = 0;
  /// The frame as grey values, upright as the file says it is to be shown. Quick in the order of time, and against it. Throws
  /// InputError (file, no line) where it does not decode.
  virtual Image<std::uint8_t> load(std::size_t index) = 0;
};

/// Whether the plug-in was built.
bool has_video();

/// Decodes the file once, to know its frames; those that are damaged are left out. Throws InputError for what is no video, and for
/// any file where the plug-in was not built, saying how to build it.
std::unique_ptr<VideoFile> open_video(const std::string& path);

}  // namespace textslam

#endif  // TEXTSLAM_IO_VIDEO_FILE_HPP
