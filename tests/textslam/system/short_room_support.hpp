// A short sequence of a rendered room, 320x240, and systems to run on it.
#ifndef TESTS_TEXTSLAM_SYSTEM_SHORT_ROOM_SUPPORT_HPP
#define TESTS_TEXTSLAM_SYSTEM_SHORT_ROOM_SUPPORT_HPP

#include <memory>
#include <string>

#include "io/image_file.hpp"
#include "io/io_support.hpp"
#include "renderer/render_sequence.hpp"
#include "textslam/input/sequence_camera.hpp"
#include "textslam/system/system.hpp"

namespace textslam {

class ShortRoom {
 public:
  explicit ShortRoom(int frames, const std::string& kind = "room") {
    RenderOptions options;
    options.kind = kind;
    options.output = folder_.path("room");
    options.frames = frames;
    options.width = 320;
    options.height = 240;
    render_sequence(options);
    sequence_ = read_sequence(options.output);
    camera_ = std::make_unique<const SequenceCamera>(sequence_.camera);
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
  /// The room outlives it.
  std::unique_ptr<System> system(const Parameters& parameters = {}) const {
    return std::make_unique<System>(camera_->view(), sequence_.camera.width, sequence_.camera.height, parameters);
  }
  /// `frame` without light.
  static Frame dark(Frame frame) {
    frame.image = std::make_shared<const Pyramid>(Image<std::uint8_t>(320, 240, 0).view(), Parameters().pyramid_levels);
    return frame;
  }

 private:
  TemporaryFolder folder_;
  Sequence sequence_;
  std::unique_ptr<const SequenceCamera> camera_;
};

}  // namespace textslam

#endif  // TESTS_TEXTSLAM_SYSTEM_SHORT_ROOM_SUPPORT_HPP
