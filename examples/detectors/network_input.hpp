// What networks that detect text get: an image in the network's size and range, one plane a colour.
#ifndef TEXTSLAM_DETECTORS_NETWORK_INPUT_HPP
#define TEXTSLAM_DETECTORS_NETWORK_INPUT_HPP

#include <array>
#include <cstdint>

#include "io/detections.hpp"

namespace textslam {

/// Pixels of three colours, and maybe more bytes, without gaps between the rows.
struct ColourView {
  const std::uint8_t* data = nullptr;
  int width = 0, height = 0;
  int bytes = 3;           ///< a pixel
  bool red_first = false;  ///< else blue
};

struct NetworkSize {
  int width, height;
};
/// In whole steps of 32 px: the longer side is about `long_side`, the shorter one in proportion.
NetworkSize network_size(int width, int height, int long_side);

/// The colours of a network in its order, as in its training: scale v + shift.
struct NetworkColours {
  struct Channel {
    double scale, shift;
  };
  bool red_first;
  std::array<Channel, 3> channels;
};
extern const NetworkColours kDbColours, kEastColours;

/// Writes 3 x height x width values: bilinear, pixel centres at whole numbers, edge pixels repeated.
void network_input(const ColourView& image, const NetworkColours& colours, const NetworkSize& size, float* out);

/// A quad in px of the network's input or its map becomes one in px of the image.
void to_image(const NetworkSize& size, int width, int height, Quad<double>* quad);

}  // namespace textslam

#endif  // TEXTSLAM_DETECTORS_NETWORK_INPUT_HPP
