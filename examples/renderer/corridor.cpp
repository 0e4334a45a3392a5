// The corridor: 2.4 m wide and 13 m long, signs on both walls, hanging across it, and at its end.
#include "renderer/furniture.hpp"
#include "renderer/kinds.hpp"

namespace textslam {

namespace {

constexpr double kLength = 13.0;
constexpr int kSigns = 18;

void add_shell(Scene& scene, const Walls& walls, std::uint64_t seed) {
  const auto own = [seed](std::uint64_t k) { return hash(seed, 100 + k); };
  scene.add(walls.front, later(plaster, walls.front.width, walls.front.height, 170.0, 1.0, own(0)), true);
  scene.add(walls.left, later(bricks, walls.left.width, walls.left.height, 125.0, own(1)), true);
  scene.add(walls.right, later(plaster, walls.right.width, walls.right.height, 160.0, 1.1, own(2)), true);
  scene.add(walls.back, later(plaster, walls.back.width, walls.back.height, 160.0, 0.8, own(3)), true);
  scene.add(walls.floor, later(tiles, walls.floor.width, walls.floor.height, 0.4, 120.0, own(4)), true);
  scene.add(walls.ceiling, later(panels, walls.ceiling.width, walls.ceiling.height, 180.0, own(5)), true);
}

}  // namespace

Scene make_corridor(std::uint64_t seed) {
  Scene scene;
  for (double y = 1.5; y < kLength; y += 2.5) scene.lamps.push_back({0.0, y, 2.5});
  const Walls walls = walls_of(-1.2, 1.2, 0.0, kLength, 2.6);
  add_shell(scene, walls, seed);
  SignPainter signs(kSigns, hash(seed, 400));
  std::uint64_t k = 500;
  const auto hang = [&](const Rectangle& wall, double s, double t, double width, double height) {
    ++k;
    scene.add(on(wall, s, t, width, height, 0.015),
              later(picture, width, height, static_cast<int>(k % 4), hash(seed, k)));
  };
  // Along the walls a sign, a picture and now and then a door, in turn; the right wall's places run from its far end.
  for (int i = 0; i < 7; ++i) {
    const double y = 3.0 + 1.3 * i, width = 0.62 + 0.16 * unit(hash(seed, 600, static_cast<std::uint64_t>(i)));
    // Every other one stands off its wall and turns towards those who come.
    if (i % 2 == 0) {
      signs.on_wall(scene, walls.left, y, 1.0, width);
      signs.board(scene, {0.95, y + 0.6, 1.7}, {-0.75, -1.0, 0.0}, 0.7 * width);
    } else {
      signs.board(scene, {-0.95, y, 1.55}, {0.75, -1.0, 0.1}, 0.7 * width);
      signs.on_wall(scene, walls.right, kLength - y - 0.6, 1.1, width);
    }
    hang(walls.left, y + 0.65, 1.25, 0.42, 0.56);
    if (i < 6) hang(walls.right, kLength - y - 1.25, 1.2, 0.44, 0.58);
  }
  for (const double s : {3.1, 8.5}) {
    scene.add(on(walls.left, s - 0.42, 1.85, 0.9, 1.3, 0.01), later(crate, 0.9, 1.3, 120.0, hash(seed, ++k)));
  }
  for (const double y : {0.7, 12.3}) {
    scene.add(on(walls.left, y, 1.55, 0.9, 2.1, 0.02), later(door, 0.9, 2.1, 115.0, hash(seed, ++k)));
    scene.add(on(walls.right, kLength - y, 1.55, 0.9, 2.1, 0.02), later(door, 0.9, 2.1, 105.0, hash(seed, ++k)));
  }
  // The end wall, and two boards across the corridor, below the ceiling.
  scene.add(on(walls.front, 0.6, 1.55, 0.9, 2.1, 0.02), later(door, 0.9, 2.1, 95.0, hash(seed, ++k)));
  signs.on_wall(scene, walls.front, 1.75, 0.95, 0.75);
  signs.on_wall(scene, walls.front, 1.75, 1.55, 0.5);
  hang(walls.front, 1.75, 0.45, 0.6, 0.4);
  signs.board(scene, {0.25, 5.6, 2.25}, {0.0, -1.0, -0.1}, 0.75);
  signs.board(scene, {-0.3, 9.4, 2.25}, {0.05, -1.0, -0.1}, 0.75);
  const auto cardboard = [seed, &k](double w, double h) { return later(crate, w, h, 130.0, hash(seed, ++k)); };
  add_box(scene, {-0.98, 6.3, 0.0}, {0.4, 0.5, 0.5}, 0.1, cardboard, cardboard);
  add_box(scene, {1.0, 8.3, 0.0}, {0.38, 0.6, 0.7}, -0.05, cardboard, cardboard);
  add_box(scene, {0.95, 3.6, 0.0}, {0.4, 0.4, 0.45}, 0.2, cardboard, cardboard);
  return scene;
}

}  // namespace textslam
