// A video file as a source of frames. Its reader is a plug-in (examples/video, -DTEXTSLAM_VIDEO=ON) that main()
// registers; a program without one says how to build it.
#ifndef TEXTSLAM_IO_VIDEO_FILE_HPP
#define TEXTSLAM_IO_VIDEO_FILE_HPP

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "io/names.hpp"

namespace textslam {

/// The frames of a video, by their number. For one thread at a time.
class VideoFile {
 public:
  virtual ~VideoFile() = default;
  /// Seconds from the first frame, one entry a frame: strictly increasing, at least one.
  virtual const std::vector<double>& times() const = 0;
  /// The frame as grey values, upright as the file says it is to be shown. Quick in the order of time, and against it.
  /// Throws InputError (file, no line) where it does not decode.
  virtual Image<std::uint8_t> load(std::size_t index) = 0;
  /// The same in colour: blue, green and red of each pixel in turn, so three times as wide. Quick after load() of the
  /// same frame.
  virtual Image<std::uint8_t> load_colour(std::size_t index) = 0;
  /// How many frames did not decode and are left out.
  virtual std::size_t damaged() const = 0;
};

using VideoOpener = std::unique_ptr<VideoFile> (*)(const std::string& path);

/// From now on open_video() calls `open`. Not beside other threads.
void register_video(VideoOpener open);

/// Whether a reader is registered.
bool has_video();

/// Decodes the file once to learn its frames, and leaves out damaged ones. Throws InputError for what is no video, and
/// for any file where no reader is registered: the message says how to build one.
std::unique_ptr<VideoFile> open_video(const std::string& path);

}  // namespace textslam

#endif  // TEXTSLAM_IO_VIDEO_FILE_HPP
