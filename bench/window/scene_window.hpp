// Windows of any size for the scaling measurement: a camera walks round inside a square room, looking outwards, and sees
// points near the walls and patches of the walls' own texture, which is a formula. The same size gives the same window
// on every platform.
#ifndef TEXTPLANE_BENCH_WINDOW_SCENE_WINDOW_HPP
#define TEXTPLANE_BENCH_WINDOW_SCENE_WINDOW_HPP

#include <string>
#include <vector>

#include "textplane/solver/window_problem.hpp"

namespace textplane_bench {

namespace tp = textplane;

/// How the camera moves, and with it which cameras share landmarks.
enum class Path {
  walk,   ///< 5 degrees a key frame, so that 72 make a round: a landmark is seen by some 7 of them a round.
  stare,  ///< 40 degrees in all: a landmark is seen by most frames, and every camera couples to every other.
};
std::string to_string(Path path);

struct WindowSize {
  Path path = Path::walk;
  int frames = 0, points = 0, texts = 0;
};

/// A window with its images and patches. Two frames are fixed; every point has three observations or more, every text
/// two; point observations carry noise of 1 px and 3 % outliers, images noise of 2 grey levels and another exposure each.
/// Poses, points and planes start some pixels away from the truth. No patch leaves an image, so that the cost is a sum
/// over the same pixels at every state.
class SceneWindow {
 public:
  explicit SceneWindow(const WindowSize& size);

  tp::Window window;

 private:
  std::vector<tp::Pyramid> images_;
  std::vector<tp::TextPatch> patches_;
};

}  // namespace textplane_bench

#endif  // TEXTPLANE_BENCH_WINDOW_SCENE_WINDOW_HPP
