// Scene: one-sided textured rectangles in the world (metres, z up), and the signs among them. Panes are rectangles that
// let light through between their letters. Some rectangles may move with time, and signs with them.
#ifndef TEXTSLAM_RENDERER_SCENE_HPP
#define TEXTSLAM_RENDERER_SCENE_HPP

#include <array>
#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "io/names.hpp"
#include "renderer/canvas.hpp"
#include "renderer/motion.hpp"
#include "renderer/texture.hpp"

namespace textslam {

/// A rectangle as its viewer sees it: `right` and `down` are orthogonal unit vectors along its sides, right x down
/// points away from the viewer. It is invisible from behind.
struct Rectangle {
  Vector3<double> corner = Vector3<double>::Zero();  ///< top left, m
  Vector3<double> right = Vector3<double>::UnitX();
  Vector3<double> down = -Vector3<double>::UnitZ();
  double width = 1.0, height = 1.0;  ///< m

  Vector3<double> at(double s, double t) const { return corner + s * right + t * down; }
  /// Unit normal, towards the viewer.
  Vector3<double> normal() const { return down.cross(right); }
};

/// The rectangle around `centre` that a viewer in direction `towards` sees upright; `roll` turns it clockwise (rad).
Rectangle facing(const Vector3<double>& centre, const Vector3<double>& towards, double width, double height,
                 double roll = 0.0);
/// A rectangle on `wall`, centred at (s, t) metres from the wall's top left, lifted off it by `lift` metres.
Rectangle on(const Rectangle& wall, double s, double t, double width, double height, double lift);

struct Surface {
  Rectangle rectangle;  ///< In the world, or in the frame of what carries it.
  const Texture* texture;
  const Texture* opacity = nullptr;  ///< 255: opaque; null: opaque all over
  const Motion* carrier = nullptr;   ///< null: it stands

  /// Where it is at a time, in the world.
  Rectangle at(double time) const;
  /// Where a place on it in the world at one time is at another.
  Vector3<double> carried(const Vector3<double>& p, double from, double to) const;
};

/// A word in the world. The corners are those of the text, not of its plate: clockwise from the text's top left as a
/// reader sees it.
struct Sign {
  int id;
  std::string word;
  std::array<Vector3<double>, 4> corner;
  Vector3<double> normal;           ///< unit, towards the reader; in the middle where it is round
  double radius = 0.0;              ///< m, of the upright cylinder that it is written on; 0: flat
  const Motion* carrier = nullptr;  ///< null: it stands; else corners and normal are in the frame of what carries it

  /// The place on the text at these shares of its width and height from the top left.
  Vector3<double> at(double across, double down) const;
  /// The sign as it stands in the world at a time.
  Sign standing(double time) const;
};

/// What paints a canvas when it is wanted.
using Paint = std::function<Canvas()>;

/// `make(values...)`, when it is wanted.
template <class... Parameters, class... Values>
Paint later(Canvas (*make)(Parameters...), Values... values) {
  return [=] { return make(values...); };
}

struct Hit {
  int surface = -1;       ///< -1: nothing
  double distance = 0.0;  ///< in units of the ray's direction
};

class Scene {
 public:
  Scene() = default;
  Scene(const Scene&) = delete;  // surfaces point to the textures
  Scene& operator=(const Scene&) = delete;
  Scene(Scene&&) = default;
  Scene& operator=(Scene&&) = default;

  /// Ceiling lamps; set them before adding the surfaces that they light.
  std::vector<Vector3<double>> lamps;

  /// A surface with the painted texture in the light of the lamps. `corners_darken`: light also fades towards the
  /// rectangle's edges, as where walls meet.
  void add(const Rectangle& rectangle, const Canvas& paint, bool corners_darken = false);
  /// The same, painted when it is first seen.
  void add(const Rectangle& rectangle, Paint paint, bool corners_darken = false);
  /// A surface with the texture as it is, unlit.
  void add_unlit(const Rectangle& rectangle, Image<std::uint8_t> texture);
  /// A painted surface through which light passes where `opacity` is below 255.
  void add_pane(const Rectangle& rectangle, const Canvas& paint, Image<std::uint8_t> opacity);
  /// `radius` of the upright cylinder that the text is written on, with the rectangle between its corners; 0: flat.
  void add_sign(std::string word, const Rectangle& text, double radius = 0.0);

  /// The surfaces from number `first` on, and the signs from number `first_sign` on (none), are in the moving frame (to
  /// the world) from here on.
  void carry(std::size_t first, Motion motion, std::size_t first_sign = SIZE_MAX);

  const std::vector<Surface>& surfaces() const noexcept { return surfaces_; }
  const std::vector<Sign>& signs() const noexcept { return signs_; }

  /// The nearest surface that the ray meets at that time beyond the distance 1e-9; panes hide nothing.
  Hit first_hit(const Vector3<double>& origin, const Vector3<double>& direction, double time = 0.0) const;

 private:
  std::deque<Texture> textures_;
  std::deque<Motion> carriers_;
  std::vector<Surface> surfaces_;
  std::vector<Sign> signs_;
};

}  // namespace textslam

#endif  // TEXTSLAM_RENDERER_SCENE_HPP
