#include "renderer/kinds.hpp"

#include <cmath>

#include "io/input_error.hpp"
#include "renderer/render_sequence.hpp"
#include "renderer/walk.hpp"

namespace textslam {

namespace {

struct Context {
  std::uint64_t seed;  // of the scene
  std::uint64_t walk;  // of path and light
  int width, height;
};

struct Kind {
  const char* name;
  Shot (*make)(const Context&);
  int frames = 240;  // by default
};

// Interruptions, s; between two frames.
constexpr double kCut = 100 / 30.0 - 1 / 60.0, kCutLength = 60 / 30.0;
constexpr double kCovered = 140 / 30.0 - 1 / 60.0, kCoveredLength = 30 / 30.0;

constexpr double kReadout = 0.03;  // s, of a rolling shutter

bool within(double t, double start, double length) { return t >= start && t < start + length; }

// A wide-angle lens such as visual-inertial sensors have.
RadialTangential<double> wide_lens() {
  RadialTangential<double> lens;
  lens.k1 = -0.28;
  lens.k2 = 0.07;
  return lens;
}

// A fisheye of 190 degrees: the circle of its image, which fits the width, ends where the polynomial stops rising, at
// 95 degrees off the axis. Near it the lens shows things smaller, as most do.
constexpr double kFisheyeEnd = 95 * M_PI / 180;
textplane::KannalaBrandt<double> fisheye_lens() {
  textplane::KannalaBrandt<double> lens;
  lens.k4 = -1 / (9 * std::pow(kFisheyeEnd, 8));
  return lens;
}
constexpr double kFisheyeFocal = 0.5 / (kFisheyeEnd * 8 / 9);

Motion with_cut(const Motion& motion, const Motion& elsewhere) {
  return [=](double t) { return within(t, kCut, kCutLength) ? elsewhere(t) : motion(t); };
}

SensorProgram with_cover(const SensorProgram& sensor) {
  return [=](double t) {
    SensorState state = sensor(t);
    if (within(t, kCovered, kCoveredLength)) state.gain = 0.0;
    return state;
  };
}

const Kind kKinds[] = {
    {"room",
     [](const Context& c) {
       return Shot{make_room(c.seed, {}), room_motion(c.walk), 0.008, steady_sensor()};
     }},
    {"room-still",
     [](const Context& c) {
       return Shot{make_room(c.seed, {}), still_then_room_motion(c.walk, 40.0 / 30.0), 0.008, steady_sensor()};
     }},
    {"corridor",
     [](const Context& c) {
       return Shot{make_corridor(c.seed), corridor_motion(c.walk), 0.006, steady_sensor()};
     }},
    {"rapid",
     [](const Context& c) {
       return Shot{make_room(c.seed, {}), rapid_motion(c.walk), 1.0 / 60.0, steady_sensor()};
     }},
    {"lights",
     [](const Context& c) {
       return Shot{make_room(c.seed, {}), room_motion(c.walk), 0.008, changing_lights(c.walk, c.width, c.height)};
     }},
    {"night",
     [](const Context& c) {
       return Shot{make_room(c.seed, {}), room_motion(c.walk), 0.008, night(c.walk)};
     }},
    {"sparse",
     [](const Context& c) {
       RoomStyle style;
       style.bare = true;
       return Shot{make_room(c.seed, style), room_motion(c.walk), 0.008, steady_sensor()};
     }},
    {"notext",
     [](const Context& c) {
       RoomStyle style;
       style.signs = false;
       return Shot{make_room(c.seed, style), room_motion(c.walk), 0.008, steady_sensor()};
     }},
    {"loop",
     [](const Context& c) {
       RoomStyle style;
       style.all_round = true;
       return Shot{make_room(c.seed, style), loop_motion(c.walk), 0.008, steady_sensor()};
     },
     360},
    {"standoff",
     [](const Context& c) {
       RoomStyle style;
       style.off_walls = true;
       return Shot{make_room(c.seed, style), room_motion(c.walk), 0.008, steady_sensor()};
     }},
    {"cylinders",
     [](const Context& c) {
       RoomStyle style;
       style.carrier = RoomStyle::Carrier::cylinder;
       return Shot{make_room(c.seed, style), room_motion(c.walk), 0.008, steady_sensor()};
     }},
    {"glass",
     [](const Context& c) {
       RoomStyle style;
       style.carrier = RoomStyle::Carrier::pane;
       return Shot{make_room(c.seed, style), room_motion(c.walk), 0.008, steady_sensor()};
     }},
    {"crowd",
     [](const Context& c) {
       Shot shot{make_room(c.seed, {}), room_motion(c.walk), 0.008, steady_sensor()};
       add_crowd(shot.scene, c.seed);
       return shot;
     }},
    {"moving",
     [](const Context& c) {
       RoomStyle style;
       style.sliding = true;
       return Shot{make_room(c.seed, style), room_motion(c.walk), 0.008, steady_sensor()};
     }},
    {"cuts",
     [](const Context& c) {
       RoomStyle style;
       style.all_round = true;
       return Shot{make_room(c.seed, style), with_cut(room_motion(c.walk), loop_motion(c.walk)), 0.008,
                   steady_sensor()};
     }},
    {"covered",
     [](const Context& c) {
       return Shot{make_room(c.seed, {}), room_motion(c.walk), 0.008, with_cover(steady_sensor())};
     }},
    {"wide",
     [](const Context& c) {
       return Shot{make_room(c.seed, {}), room_motion(c.walk), 0.008, steady_sensor(), wide_lens()};
     }},
    {"uncalibrated",
     [](const Context& c) {
       Shot shot{make_room(c.seed, {}), room_motion(c.walk), 0.008, steady_sensor(), wide_lens()};
       shot.calibrated = false;
       return shot;
     }},
    {"shutter",
     [](const Context& c) {
       return Shot{make_room(c.seed, {}),      room_motion(c.walk), 0.008,   steady_sensor(),
                   RadialTangential<double>{}, Shot().focal,        kReadout};
     }},
    {"fisheye",
     [](const Context& c) {
       return Shot{make_room(c.seed, {}), room_motion(c.walk), 0.008, steady_sensor(), fisheye_lens(), kFisheyeFocal};
     }},
};

const Kind& kind_of(const std::string& name) {
  for (const Kind& kind : kKinds) {
    if (name == kind.name) return kind;
  }
  std::string known;
  for (const Kind& kind : kKinds) known += std::string(known.empty() ? "" : ", ") + kind.name;
  throw InputError("--render " + name, 0, "no such kind; known are " + known);
}

}  // namespace

std::vector<std::string> render_kinds() {
  std::vector<std::string> names;
  for (const Kind& kind : kKinds) names.emplace_back(kind.name);
  return names;
}

Shot make_shot(const std::string& name, std::uint64_t seed, int width, int height, int walk) {
  const std::uint64_t own = seed_of_walk(seed, walk);
  Shot shot = kind_of(name).make({seed, own, width, height});
  if (walk > 0) take_walk(own, &shot);
  return shot;
}

int default_frames(const std::string& name) { return kind_of(name).frames; }

}  // namespace textslam
