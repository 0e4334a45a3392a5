// Furniture: the parts of scenes: rooms of six rectangles, boxes, pictures and sign boards.
#ifndef TEXTSLAM_RENDERER_FURNITURE_HPP
#define TEXTSLAM_RENDERER_FURNITURE_HPP

#include <functional>
#include <string>
#include <vector>

#include "renderer/materials.hpp"
#include "renderer/sign_plate.hpp"

namespace textslam {

/// The inside of a box with its floor at z = 0.
struct Walls {
  Rectangle front, left, right, back, floor, ceiling;  ///< front is at the largest y
};
Walls walls_of(double x0, double x1, double y0, double y1, double height);

/// What paints a side of this width and height (m).
using Painter = std::function<Paint(double, double)>;

/// A box on the floor: centre of its base at `foot`, size x wide, y deep, z high, turned by `yaw` (radians,
/// counter-clockwise from above; at 0 the front faces -y). No bottom. Returns its front.
Rectangle add_box(Scene& scene, const Vector3<double>& foot, const Vector3<double>& size, double yaw,
                  const Painter& front, const Painter& sides);

/// Chooses words, fonts and plates, and puts signs into a scene.
class SignPainter {
 public:
  SignPainter(int words, std::uint64_t seed);

  /// On a wall or a box, centred at (s, t) metres from its top left; `width` of the plate in metres.
  void on_wall(Scene& scene, const Rectangle& wall, double s, double t, double width);
  /// As on_wall(), but 2 to 10 cm off the wall at the nearest edge, and turned by up to 15 degrees.
  void off_wall(Scene& scene, const Rectangle& wall, double s, double t, double width);
  /// Round an upright cylinder whose front is at `front` and faces `towards` (horizontal). `width` along the arc.
  void cylinder(Scene& scene, const Vector3<double>& front, const Vector3<double>& towards, double width,
                double radius);
  /// Letters on a clear pane, seen from the side that faces `towards`.
  void pane(Scene& scene, const Vector3<double>& centre, const Vector3<double>& towards, double width);
  /// On a board in the room: text on the side that faces `towards`, blank behind.
  void board(Scene& scene, const Vector3<double>& centre, const Vector3<double>& towards, double width,
             double roll = 0.0);

 private:
  struct Made {
    std::string word;
    SignPlate plate;
  };
  Made next(double width);
  static void add_text(Scene& scene, const Rectangle& plate_at, const Made& made);

  Random random_;
  std::vector<Font> fonts_;
  std::vector<std::string> words_;
  std::size_t used_ = 0;
};

}  // namespace textslam

#endif  // TEXTSLAM_RENDERER_FURNITURE_HPP
