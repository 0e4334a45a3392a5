// Materials of walls, floors and furniture, painted in metres. They show no letters: only signs do.
#ifndef TEXTSLAM_RENDERER_MATERIALS_HPP
#define TEXTSLAM_RENDERER_MATERIALS_HPP

#include <cstdint>

#include "io/names.hpp"
#include "renderer/canvas.hpp"

namespace textslam {

/// Clean paint with faint traces of the roller.
Canvas bare_wall(double width, double height, double base, std::uint64_t seed);
/// Old plaster: clouds, speckles, chips and a few cracks. `strength` 1 is a wall with many corners.
Canvas plaster(double width, double height, double base, double strength, std::uint64_t seed);
Canvas bricks(double width, double height, double base, std::uint64_t seed);
/// Boards with grain and knots, upright or lying.
Canvas boards(double width, double height, double base, bool upright, std::uint64_t seed);
/// Square tiles of terrazzo with joints.
Canvas tiles(double width, double height, double side, double base, std::uint64_t seed);
/// Ceiling panels with dark joints and holes.
Canvas panels(double width, double height, double base, std::uint64_t seed);
/// Shelves full of books, seen from the front: frame, spines with bands, gaps.
Canvas book_shelf(double width, double height, std::uint64_t seed);
/// A door leaf with panels, a frame and a handle.
Canvas door(double width, double height, double base, std::uint64_t seed);
/// A parcel or crate: boards or cardboard with tape, scuffs and stickers.
Canvas crate(double width, double height, double base, std::uint64_t seed);
/// A framed picture without letters: a landscape, shapes, blossoms or a mosaic for the styles 0 to 3.
Canvas picture(double width, double height, int style, std::uint64_t seed);

}  // namespace textslam

#endif  // TEXTSLAM_RENDERER_MATERIALS_HPP
