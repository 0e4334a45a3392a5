// Taps of neighbouring pixels by windows (see simd/windows.hpp). Eight pixels in a row are a group; the left-most and the top-most
// of its cells is taken to be the first's or the last's, whichever the direction says. That is a guess, and so is the size of a
// group: what a window does not hold is told, and must be fetched one by one. The bytes are the same then.

// How groups of n points run whose targets move by about (a du + b dv, c du + d dv): by some of them.
TEXTPLANE_SIMD_INLINE TapGuess guess_windows(const float* u, const float* v, int n, float a, float b, float c,
                                             float d) noexcept {
  TapGuess guess = {false, false, false};
  if (kTapWindows == 0 || n < 64) return guess;
  const int quarter = n / 32 * 8;
  int dense = 0;
  float across = 0, down = 0;
  for (int at = 0; at < 4 * quarter; at += quarter) {
    const float du = u[at + 7] - u[at], dv = v[at + 7] - v[at], dx = a * du + b * dv, dy = c * du + d * dv;
    if (dx > -13.0F && dx < 13.0F && dy > -1.0F && dy < 1.0F) {
      across += dx;
      down += dy;
      ++dense;
    } else if (dense == 0) {
      return guess;
    }
  }
  guess.likely = dense >= 3;
  guess.leftwards = across < 0;
  guess.upwards = down < 0;
  return guess;
}

// (ox, oy) is the pixel at `origin`. False where there is no room for a window, and where cells or the stride are not int16.
TEXTPLANE_SIMD_INLINE bool make_windows(const std::uint8_t* data, std::ptrdiff_t stride, int width, int height, int ox,
                                        int oy, TapWindows* w) noexcept {
  w->origin = data + (oy * stride + ox);
  w->stride = stride;
  w->x_high = width - 16 - ox;
  w->y_high = height - 3 - oy;
  w->guess.likely = false;
  return kTapWindows != 0 && width >= 16 && height >= 3 && width < 16384 && height < 16384 && stride < 32768;
}
