// The pixels of a patch as bytes: its arrays one after another, as 32-bit floats, little-endian.
#ifndef TEXTSLAM_MAP_FILE_PIXEL_BYTES_HPP
#define TEXTSLAM_MAP_FILE_PIXEL_BYTES_HPP

#include <string>
#include <string_view>

#include "textplane/photometry/patch.hpp"

namespace textslam {

/// Arrays of a level: x, y, intensity, gx, gy, and behind a lens taken_x and taken_y.
constexpr int kPlainArrays = 5, kLensArrays = 7;

inline int arrays_of(const textplane::PatchLevel& level) { return level.taken_x.empty() ? kPlainArrays : kLensArrays; }

std::string to_bytes(const textplane::PatchLevel& level);

/// False where the bytes do not divide into so many arrays, or a number is not finite.
bool from_bytes(std::string_view bytes, int arrays, textplane::PatchLevel* level);

}  // namespace textslam

#endif  // TEXTSLAM_MAP_FILE_PIXEL_BYTES_HPP
