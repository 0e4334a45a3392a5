// A short sequence of the rendered room, 320x240, and systems to run on it.
#ifndef TESTS_TEXTSLAM_SYSTEM_SHORT_ROOM_SUPPORT_HPP
#define TESTS_TEXTSLAM_SYSTEM_SHORT_ROOM_SUPPORT_HPP

#include <memory>

#include "io/image_file.hpp"
#include "io/io_support.hpp"
#include "renderer/render_sequence.hpp"
#include "textslam/system/system.hpp"

namespace textslam {

class ShortRoom {
 public:
  explicit ShortRoom(int frames) {
    RenderOptions options;
    options.output = folder_.path("room");
    options.frames = frames;
    options.width = 320;
    options.height = 240;
    render_sequence(options);
    sequence_ = read_sequence(options.output);
  }

  const Sequence& sequence() const { return sequence_; }
  Frame load(int index) const {
    const auto at = static_cast<std::size_t>(index);
    Frame frame;
    frame.index = index;
    frame.timestamp = sequence_.frames[at].timestamp;
    frame.image = std::make_shared<const Pyramid>(load_frame(sequence_, at).view(), Parameters().pyramid_levels);
    return frame;
  }
  std::unique_ptr<System> system(const Parameters& parameters = {}) const {
    return std::make_unique<System>(sequence_.camera.pinhole(), sequence_.camera.width, sequence_.camera.height,
                                    parameters);
  }
  /// `frame` without light.
  static Frame dark(Frame frame) {
    frame.image = std::make_shared<const Pyramid>(Image<std::uint8_t>(320, 240, 0).view(), Parameters().pyramid_levels);
    return frame;
  }

 private:
  TemporaryFolder folder_;
  Sequence sequence_;
};

}  // namespace textslam

#endif  // TESTS_TEXTSLAM_SYSTEM_SHORT_ROOM_SUPPORT_HPP
