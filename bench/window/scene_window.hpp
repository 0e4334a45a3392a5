// Windows of any size for the measurement of scaling. A camera walks round in a square room and looks outwards. It sees
// points near the walls and patches of the walls, whose texture is a formula. The same size gives the same window on
// every platform.
#ifndef TEXTPLANE_BENCH_WINDOW_SCENE_WINDOW_HPP
#define TEXTPLANE_BENCH_WINDOW_SCENE_WINDOW_HPP

#include <string>
#include <vector>

#include "textplane/solver/window_problem.hpp"

namespace textplane_bench {

namespace tp = textplane;

/// How the camera moves. This decides which cameras share landmarks.
enum class Path {
  walk,   ///< 5 degrees a key frame, 72 for a round: some 7 key frames of a round see a landmark.
  stare,  ///< 40 degrees in all: most frames see a landmark, and every camera shares landmarks with every other.
};
std::string to_string(Path path);

struct WindowSize {
  Path path = Path::walk;
  int frames = 0, points = 0, texts = 0;
};

/// A window with its images and patches. Two frames are fixed. A point has at least three observations, a text two.
/// Point observations have noise of 1 px and 3 % outliers; images have noise of 2 grey levels and different exposures.
/// Poses, points and planes start some pixels off the truth. No patch leaves an image, so the cost always sums over the
/// same pixels.
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
