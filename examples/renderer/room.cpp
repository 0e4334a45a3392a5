// The room: 4.8 m x 4.2 m, signs on three walls, on furniture and on slanted boards; the camera moves in its rear half.
#include <cmath>
#include <utility>

#include "renderer/furniture.hpp"
#include "renderer/kinds.hpp"

namespace textslam {

namespace {

constexpr double kPictureLift = 0.015;  // m
constexpr int kRoomSigns = 12, kSignsBehind = 6;

void add_shell(Scene& scene, const Walls& walls, bool bare, std::uint64_t seed) {
  const auto wall = [&](const Rectangle& r, Paint paint) { scene.add(r, std::move(paint), true); };
  const auto own = [seed](std::uint64_t k) { return hash(seed, 100 + k); };
  if (bare) {
    std::uint64_t k = 0;
    for (const Rectangle* r : {&walls.front, &walls.left, &walls.right, &walls.back, &walls.floor, &walls.ceiling}) {
      wall(*r, later(bare_wall, r->width, r->height, k == 4 ? 95.0 : 165.0 + 4.0 * static_cast<double>(k % 3), own(k)));
      ++k;
    }
    return;
  }
  wall(walls.front, later(plaster, walls.front.width, walls.front.height, 165.0, 1.0, own(0)));
  wall(walls.left, later(bricks, walls.left.width, walls.left.height, 110.0, own(1)));
  wall(walls.right, later(boards, walls.right.width, walls.right.height, 125.0, true, own(2)));
  wall(walls.back, later(plaster, walls.back.width, walls.back.height, 150.0, 0.7, own(3)));
  wall(walls.floor, later(boards, walls.floor.width, walls.floor.height, 95.0, false, own(4)));
  wall(walls.ceiling, later(panels, walls.ceiling.width, walls.ceiling.height, 175.0, own(5)));
}

void add_pictures(Scene& scene, const Walls& walls, std::uint64_t seed) {
  struct Place {
    const Rectangle* wall;
    double s, t, width, height;
  };
  // Metres from the top left of each wall, as seen from inside.
  const Place places[] = {{&walls.front, 1.45, 0.5, 0.42, 0.56}, {&walls.front, 2.62, 1.3, 0.5, 0.42},
                          {&walls.front, 4.3, 1.55, 0.5, 0.66},  {&walls.front, 3.75, 0.42, 0.62, 0.42},
                          {&walls.left, 2.55, 0.62, 0.5, 0.42},  {&walls.left, 2.6, 1.75, 0.55, 0.75},
                          {&walls.left, 1.25, 1.3, 0.5, 0.7},    {&walls.left, 3.75, 1.7, 0.42, 0.56},
                          {&walls.right, 1.45, 1.65, 0.6, 0.5},  {&walls.right, 1.5, 0.65, 0.5, 0.62},
                          {&walls.right, 2.75, 0.7, 0.55, 0.4},  {&walls.right, 3.4, 1.4, 0.5, 0.7},
                          {&walls.back, 1.2, 1.1, 0.8, 0.6},     {&walls.back, 3.4, 1.0, 0.6, 0.8}};
  int k = static_cast<int>(seed % 4);
  for (const Place& p : places) {
    const Rectangle r = on(*p.wall, p.s, p.t, p.width, p.height, kPictureLift);
    scene.add(r, later(picture, p.width, p.height, k % 4, hash(seed, 200, static_cast<std::uint64_t>(k))));
    ++k;
  }
}

struct Furnishing {
  Rectangle shelf, cabinet;
};

Furnishing add_furniture(Scene& scene, std::uint64_t seed) {
  std::uint64_t k = 300;
  const auto cardboard = [seed, &k](double w, double h) { return later(crate, w, h, 135.0, hash(seed, ++k)); };
  const auto dark = [seed, &k](double w, double h) { return later(boards, w, h, 100.0, true, hash(seed, ++k)); };
  const auto books = [seed, &k](double w, double h) { return later(book_shelf, w, h, hash(seed, ++k)); };
  Furnishing f;
  f.shelf = add_box(scene, {-1.45, 1.93, 0.0}, {0.95, 0.3, 1.75}, 0.0, books, dark);
  f.cabinet = add_box(scene, {0.85, 1.78, 0.0}, {1.1, 0.5, 0.75}, 0.0, dark, dark);
  add_box(scene, {1.0, 1.8, 0.75}, {0.34, 0.3, 0.26}, 0.3, cardboard, cardboard);
  add_box(scene, {-2.05, 0.75, 0.0}, {0.5, 0.5, 0.55}, 0.45, cardboard, cardboard);
  add_box(scene, {-2.1, 0.72, 0.55}, {0.35, 0.35, 0.3}, 0.1, cardboard, cardboard);
  add_box(scene, {2.0, 0.95, 0.0}, {0.55, 0.6, 0.62}, -0.5, cardboard, cardboard);
  return f;
}

// Six signs in the room, each on a cylinder or a pane.
void add_carried(Scene& scene, SignPainter& signs, RoomStyle::Carrier carrier, std::uint64_t seed) {
  const Vector3<double> places[] = {{1.55, 1.25, 1.0}, {-0.45, 1.3, 0.8}, {0.3, 1.25, 2.2},
                                    {-0.1, 1.7, 1.95}, {0.8, 1.75, 1.65}, {-2.0, 1.3, 2.1}};
  std::uint64_t k = 0;
  for (const Vector3<double>& place : places) {
    const auto draw = [&](double low, double high) { return low + (high - low) * unit(hash(seed, 500, ++k)); };
    const Vector3<double> towards(draw(-0.2, 0.2) - 0.15 * place[0], -1.0, 0.0);
    const double radius = draw(0.2, 0.3);
    if (carrier == RoomStyle::Carrier::cylinder) {
      signs.cylinder(scene, place, towards, draw(1.5, 2.0) * radius, radius);
    } else {
      signs.pane(scene, place, towards, draw(0.45, 0.65));
    }
  }
}

/// To and fro along x, not quite as far as the pictures and signs beside it.
Motion slide(std::uint64_t seed) {
  constexpr double kSlide = 0.22;  // m
  const double period = 3.0 + 2.0 * unit(hash(seed, 700)), phase = unit(hash(seed, 701));
  return [=](double t) {
    return SE3d{Matrix3<double>::Identity(), {kSlide * std::sin(6.283185307179586 * (t / period + phase)), 0.0, 0.0}};
  };
}

void add_signs(Scene& scene, const Walls& walls, const Furnishing* furniture, const RoomStyle& style,
               std::uint64_t seed) {
  SignPainter signs(kRoomSigns + (style.all_round ? kSignsBehind : 0), hash(seed, 400));
  const auto hang = [&](const Rectangle& wall, double s, double t, double width) {
    style.off_walls ? signs.off_wall(scene, wall, s, t, width) : signs.on_wall(scene, wall, s, t, width);
  };
  const bool boards = style.carrier == RoomStyle::Carrier::board;
  if (boards) {
    const std::size_t surface = scene.surfaces().size();
    hang(walls.front, 2.3, 0.75, 0.7);
    if (style.sliding) scene.carry(surface, slide(seed), scene.signs().size() - 1);
    hang(walls.front, 3.2, 1.05, 0.56);
  }
  hang(walls.front, 4.25, 0.9, 0.5);
  if (boards) hang(walls.front, 0.48, 0.55, 0.56);
  hang(walls.left, 3.5, 0.8, 0.7);
  hang(walls.left, 2.75, 1.12, 0.6);
  hang(walls.right, 0.7, 0.95, 0.62);
  hang(walls.right, 1.5, 1.18, 0.62);
  if (boards) {
    // Slanted: a lectern on the right, an easel on the left, and one that hangs from the ceiling.
    signs.board(scene, {1.55, 1.25, 1.0}, {-0.35, -1.0, 0.55}, 0.52);
    signs.board(scene, {-0.45, 1.3, 0.8}, {0.3, -1.0, 0.3}, 0.6, 0.06);
    signs.board(scene, {0.3, 1.25, 2.2}, {-0.15, -1.0, -0.35}, 0.66);
  } else {
    add_carried(scene, signs, style.carrier, seed);
  }
  if (furniture) {
    hang(furniture->cabinet, 0.55, 0.35, 0.45);
  } else {
    hang(walls.front, 2.75, 1.75, 0.6);
  }
  if (!style.all_round) return;
  hang(walls.right, 2.3, 1.3, 0.5);
  hang(walls.right, 3.75, 0.75, 0.54);
  hang(walls.back, 2.35, 0.9, 0.66);
  hang(walls.back, 4.25, 1.2, 0.56);
  hang(walls.back, 0.45, 1.25, 0.56);
  hang(walls.left, 0.6, 0.95, 0.58);
}

}  // namespace

Scene make_room(std::uint64_t seed, const RoomStyle& style) {
  Scene scene;
  scene.lamps = {{-0.9, -0.2, 2.6}, {1.1, 0.4, 2.6}};
  const Walls walls = walls_of(-2.4, 2.4, -2.1, 2.1, 2.7);
  add_shell(scene, walls, style.bare, seed);
  Furnishing furniture;
  if (!style.bare) {
    add_pictures(scene, walls, seed);
    furniture = add_furniture(scene, seed);
  }
  if (style.signs) add_signs(scene, walls, style.bare ? nullptr : &furniture, style, seed);
  return scene;
}

}  // namespace textslam
