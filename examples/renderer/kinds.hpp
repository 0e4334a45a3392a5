// Kinds: sequences that can be rendered by name. Each is a scene, a motion, a shutter, a sensor and a lens.
//
// A sweep replaces a part of the kind: blur its shutter, gain and noise those of its sensor (conditions.hpp). The
// detector's errors are the same for all kinds (detector_model.hpp).
#ifndef TEXTSLAM_RENDERER_KINDS_HPP
#define TEXTSLAM_RENDERER_KINDS_HPP

#include <cstdint>
#include <string>
#include <vector>

#include "renderer/motion.hpp"
#include "renderer/scene.hpp"
#include "renderer/sensor.hpp"

namespace textslam {

struct Shot {
  Scene scene;
  Motion motion;
  double exposure = 0.008;  ///< s
  SensorProgram sensor;
  textplane::AnyCamera<double> lens = RadialTangential<double>{};  ///< Its coefficients.
  double focal = 525.0 / 640.0;                                    ///< Focal length, of the image's width.
  double readout = 0;      ///< s from the first row to the last; the middle is at the frame's time.
  bool calibrated = true;  ///< The sequence has its camera; else only what judges an estimate of it.
};

/// Number of frames, at 30 a second, that show the whole kind. Throws as make_shot() does.
int default_frames(const std::string& kind);

/// `walk`: which visit to the scene (walk.hpp). Throws InputError that lists the kinds for an unknown name,
/// std::runtime_error where no font is found.
Shot make_shot(const std::string& kind, std::uint64_t seed, int width, int height, int walk = 0);

/// How a room is furnished.
struct RoomStyle {
  bool signs = true;
  bool bare = false;       ///< clean walls, no furniture: little texture but the signs
  bool all_round = false;  ///< signs on the back wall, too, and on the rear parts of the side walls
  bool off_walls = false;  ///< signs of walls stand off them and are turned
  bool sliding = false;    ///< one sign slides to and fro along the front wall
  /// What carries six of the signs, in the place of boards and the front wall.
  enum class Carrier { board, cylinder, pane } carrier = Carrier::board;
};
Scene make_room(std::uint64_t seed, const RoomStyle& style);
Scene make_corridor(std::uint64_t seed);
/// Three people who walk to and fro across the room, at .5 to 1.5 m/s, two of them in front of the camera at first.
void add_crowd(Scene& scene, std::uint64_t seed);

}  // namespace textslam

#endif  // TEXTSLAM_RENDERER_KINDS_HPP
