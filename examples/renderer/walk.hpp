// Walks: other visits to a scene. The signs hang where they hung; path, light, noise and the detector's errors are
// others.
#ifndef TEXTSLAM_RENDERER_WALK_HPP
#define TEXTSLAM_RENDERER_WALK_HPP

#include <cstdint>

#include "renderer/kinds.hpp"

namespace textslam {

/// The seed of all that a visit does not share with others. Walk 0 is the kind as it is: `seed` itself.
std::uint64_t seed_of_walk(std::uint64_t seed, int walk);

/// Moves the path of a walk above 0: it begins elsewhere on its way and lies up to 0.3 m beside it, 0.15 m above or
/// below. The camera looks up to 7 degrees aside. The light is 0.6 to 1.4 times as bright, up to 12 grey levels off.
void take_walk(std::uint64_t seed_of_walk, Shot* shot);

}  // namespace textslam

#endif  // TEXTSLAM_RENDERER_WALK_HPP
