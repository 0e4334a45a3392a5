// Taps of neighbouring pixels by tiles. Include before: the operations.
//
// Eight neighbours share a guessed 16 x 3 tile; pixels outside it are loaded one by one. The guess: the left-most and
// the top-most of the eight cells is the first or the last, as the direction of the rows says. The bytes are the same
// either way.

// The taps of cells (x, y), 0 <= x <= 14 and 0 <= y <= 1, of the tile at corner[i / kTileLanes].
TEXTPLANE_SIMD_INLINE taps_t tile_taps(const std::uint8_t* const* corner, std::ptrdiff_t stride, vi x, vi y) noexcept {
  const vi picks = tile_picks(x);
  const vi a = pick_bytes(tile_rows(corner, 0), picks);
  const vi b = pick_bytes(tile_rows(corner, stride), picks);
  return two_rows(y, a, b, pick_bytes(tile_rows(corner, 2 * stride), picks));
}

// How groups of n points run whose targets move by about (a du + b dv, c du + d dv): by some of them.
TEXTPLANE_SIMD_INLINE TileGuess guess_tiles(const float* u, const float* v, int n, float a, float b, float c,
                                            float d) noexcept {
  TileGuess guess = {false, false, false};
  if (kInt16Tiles == 0 || n < 64) return guess;
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

// (ox, oy) is the pixel at `origin`. False where there is no room for a tile, and where cells or the stride are not
// int16.
TEXTPLANE_SIMD_INLINE bool make_tiles(const std::uint8_t* data, std::ptrdiff_t stride, int width, int height, int ox,
                                      int oy, ImageTiles* w) noexcept {
  w->origin = data + (oy * stride + ox);
  w->stride = stride;
  w->x_high = width - 16 - ox;
  w->y_high = height - 3 - oy;
  w->guess.likely = false;
  return kInt16Tiles != 0 && width >= 16 && height >= 3 && width < 16384 && height < 16384 && stride < 32768;
}
