#include "textslam/calibrate/frame_pairs.hpp"

#include <algorithm>
#include <utility>

#include "io/input_error.hpp"
#include "io/interrupt.hpp"
#include "textslam/input/make_frame.hpp"
#include "textslam/input/sequence_camera.hpp"
#include "textslam/track/feature_tracks.hpp"

namespace textslam {

std::vector<FramePair> follow_frames(const Sequence& sequence, const std::vector<std::size_t>& frames, std::size_t most,
                                     const Parameters& parameters,
                                     const std::function<bool(const std::vector<FramePair>&, std::size_t)>& go_on) {
  const CameraModel& model = sequence.camera;
  const SequenceCamera camera(model);
  const Parameters sized = at_size(parameters, model.width, model.height);
  const auto row = [&](const Vec2& px) { return px.y() / (model.height - 1) - 0.5; };
  const auto ray = [&](const Vec2& px) { return Vec3(ray_of(camera.view(), px).normalized()); };
  std::vector<FramePair> pairs;
  std::vector<Track> tracks;
  Frame before;
  const std::size_t count = std::min(frames.size(), most);
  for (std::size_t i = 0; i < count && interrupted() == 0; ++i) {
    Frame frame;
    try {
      const std::size_t at = frames[i];
      frame = make_frame(static_cast<int>(i), sequence.frames[at].timestamp, load_frame(sequence, at), sized);
    } catch (const InputError&) {
      break;
    }
    if (i > 0) {
      for (Track& track : tracks) track.observations = {{0, track.px.cast<double>()}};
      advance_tracks(before, frame, camera.view(), {}, sized, tracks);
      pairs.push_back({frame.timestamp - before.timestamp, {}});
      for (const Track& track : tracks) {
        const Vec2 a = track.observations.front().px, b = track.px.cast<double>();
        pairs.back().rays.push_back({ray(a), ray(b), row(a), row(b)});
      }
    }
    add_corners(frame, camera.view(), 0, {}, sized, tracks);
    before = std::move(frame);
    if (!go_on(pairs, count)) break;
  }
  return pairs;
}

}  // namespace textslam
