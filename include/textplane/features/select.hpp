// Selection: which pixels represent a text object, and which corners of an image are worth tracking.
//
// Section IV-A of the paper: text is represented by FAST points inside its quad, at least 15 of them. Here they are
// distributed evenly over the quad, and pixels of strong gradient fill the gaps, so that a sum over them constrains the
// whole plane.
#ifndef TEXTPLANE_FEATURES_SELECT_HPP
#define TEXTPLANE_FEATURES_SELECT_HPP

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "textplane/features/fast.hpp"
#include "textplane/geometry/quad.hpp"
#include "textplane/photometry/patch.hpp"
#include "textplane/photometry/pyramid.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// Parameters of select_pixels() and make_patch().
struct SelectOptions {
  int min_pixels = 15;            ///< The paper's minimum; fewer is Status::too_few. At least 0.
  int max_pixels = 300;           ///< On each level; at least 1.
  int levels = 3;                 ///< Pyramid levels of a patch; at least 1. More than there are: all.
  int fast_threshold = 20;        ///< Intensity, in [0, 255]; lowered stepwise until half of max_pixels are corners.
  int lowest_fast_threshold = 5;  ///< Intensity, in [0, 255]: it is not lowered further.
  /// Intensity per px, at least 0: smallest central difference of a pixel that fills a gap.
  float min_gradient = 4.0F;

  /// Whether the numbers make sense.
  bool valid() const noexcept {
    return min_pixels >= 0 && max_pixels >= 1 && levels >= 1 && fast_threshold >= 0 && fast_threshold <= 255 &&
           lowest_fast_threshold >= 0 && lowest_fast_threshold <= 255 && is_finite(min_gradient) && min_gradient >= 0;
  }
};

namespace detail {

// A grid of square cells over [x0, x0 + width) x [y0, y0 + height).
struct CellGrid {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0, cell = 1, columns = 0, rows = 0;

  // width, height and cell are positive, and x0 + width and y0 + height are numbers.
  CellGrid(int x0_, int y0_, int width, int height, int cell_) noexcept
      : x0(x0_),
        y0(y0_),
        x1(x0_ + width),
        y1(y0_ + height),
        cell(cell_),
        columns((width - 1) / cell_ + 1),
        rows((height - 1) / cell_ + 1) {}

  std::size_t size() const noexcept { return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows); }
  bool contains(float x, float y) const noexcept {
    return is_finite(x) && is_finite(y) && x >= static_cast<float>(x0) && y >= static_cast<float>(y0) &&
           x < static_cast<float>(x1) && y < static_cast<float>(y1);
  }
  // The caller has checked contains().
  std::size_t index(float x, float y) const noexcept {
    const int c = (static_cast<int>(x) - x0) / cell, r = (static_cast<int>(y) - y0) / cell;
    return static_cast<std::size_t>(r) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(c);
  }
};

// Strongest first; equal scores in raster order, so that the result does not depend on the sort.
TEXTPLANE_DEFERRED
void sort_by_score(std::vector<Corner>* corners) {
  std::sort(corners->begin(), corners->end(), [](const Corner& a, const Corner& b) {
    if (a.score != b.score) return a.score > b.score;
    return a.y != b.y ? a.y < b.y : a.x < b.x;
  });
}

// Integer pixel rectangle [x0, x1) x [y0, y1).
struct PixelBox {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  bool empty() const noexcept { return x0 >= x1 || y0 >= y1; }
};

// Round a polygon that lies inside the image.
TEXTPLANE_DEFERRED
PixelBox pixel_box(const ConvexPolygon<double>& polygon) noexcept {
  if (polygon.empty()) return {};
  Bounds<double> b{polygon[0], polygon[0]};
  for (int i = 1; i < polygon.size(); ++i) {
    for (int k = 0; k < 2; ++k) {
      b.min[k] = (std::min)(b.min[k], polygon[i][k]);
      b.max[k] = (std::max)(b.max[k], polygon[i][k]);
    }
  }
  return {static_cast<int>(std::ceil(b.min[0])), static_cast<int>(std::ceil(b.min[1])),
          static_cast<int>(std::floor(b.max[0])) + 1, static_cast<int>(std::floor(b.max[1])) + 1};
}

// Corners inside the region, at the highest threshold that gives `enough` of them, or at the lowest.
TEXTPLANE_DEFERRED
std::vector<Corner> corners_in_region(const ImageView8& image, const ConvexPolygon<double>& region, const PixelBox& box,
                                      const SelectOptions& options, int enough) {
  // The detector skips 3 px at each border of its image.
  const int x0 = (std::max)(box.x0 - 3, 0), y0 = (std::max)(box.y0 - 3, 0);
  const int x1 = (std::min)(box.x1 + 3, image.width()), y1 = (std::min)(box.y1 + 3, image.height());
  const ImageView8 part(image.row(y0) + x0, x1 - x0, y1 - y0, image.stride());
  std::vector<Corner> found, inside;
  detect_fast(part, (std::min)(options.fast_threshold, options.lowest_fast_threshold), true, found);
  for (Corner c : found) {
    c.x += static_cast<float>(x0);
    c.y += static_cast<float>(y0);
    if (contains(region, Vector2<double>(c.x, c.y))) inside.push_back(c);
  }
  keep_enough(&inside, options.fast_threshold, options.lowest_fast_threshold, enough, [](int t) { return t * 3 / 4; });
  return inside;
}

// Takes corners in rounds, at most one from each cell in a round, strongest first.
TEXTPLANE_DEFERRED
void take_in_rounds(std::vector<Corner>& corners, const CellGrid& grid, int max_pixels, std::vector<Corner>* out) {
  sort_by_score(&corners);
  std::vector<int> taken(grid.size(), 0);
  for (int round = 0; !corners.empty(); ++round) {
    std::size_t left = 0;
    for (const Corner& c : corners) {
      int& n = taken[grid.index(c.x, c.y)];
      if (n > round) {
        corners[left++] = c;
        continue;
      }
      if (static_cast<int>(out->size()) >= max_pixels) return;
      out->push_back(c);
      ++n;
    }
    corners.resize(left);
  }
}

// The pixel of largest gradient of every cell without a pixel in `out`, strongest cells first.
TEXTPLANE_DEFERRED
void fill_by_gradient(const ImageView8& image, const ConvexPolygon<double>& region, const PixelBox& box,
                      const CellGrid& grid, const SelectOptions& options, std::vector<Corner>* out) {
  std::vector<Corner> best(grid.size());
  for (const Corner& p : *out) best[grid.index(p.x, p.y)].score = -1.0F;
  const int x0 = (std::max)(box.x0, 1), y0 = (std::max)(box.y0, 1);
  const int x1 = (std::min)(box.x1, image.width() - 1), y1 = (std::min)(box.y1, image.height() - 1);
  const float gradient = (std::min)(options.min_gradient, 1e6F);  // more than any, and its square is a number
  const float least = 4.0F * gradient * gradient;                 // the differences below are doubled
  for (int y = y0; y < y1; ++y) {
    const std::uint8_t* above = image.row(y - 1);
    const std::uint8_t* row = image.row(y);
    const std::uint8_t* below = image.row(y + 1);
    for (int x = x0; x < x1; ++x) {
      const int gx = row[x + 1] - row[x - 1], gy = below[x] - above[x];
      const float strength = static_cast<float>(gx * gx + gy * gy);
      if (strength < least) continue;
      Corner& b = best[grid.index(static_cast<float>(x), static_cast<float>(y))];
      if (b.score < 0.0F || strength <= b.score || !contains(region, Vector2<double>(x, y))) continue;
      b = {static_cast<float>(x), static_cast<float>(y), strength};
    }
  }
  best.erase(std::remove_if(best.begin(), best.end(), [](const Corner& c) { return !(c.score > 0.0F); }), best.end());
  sort_by_score(&best);
  for (const Corner& c : best) {
    if (static_cast<int>(out->size()) >= options.max_pixels) return;
    out->push_back(c);
  }
}

}  // namespace detail

/// Representative pixels of a quad in an image: FAST corners inside it, distributed over a grid of about max_pixels
/// cells, then the pixel of strongest gradient of every cell of a finer grid that is still empty, at most max_pixels in
/// all. `quad`: px of `image`; the part of its convex hull inside the image counts. `out`: integer positions, replaced,
/// each pixel once. Deterministic. Status::too_few where fewer than min_pixels qualify (`out` then holds those),
/// degenerate for a quad without area, non_finite, invalid_argument (also for options that are not valid()). Allocates.
TEXTPLANE_DEFERRED
Status select_pixels(const ImageView8& image, const Quad<double>& quad, const SelectOptions& options,
                     std::vector<Vector2<float>>& out) {
  out.clear();
  if (!image.valid() || !options.valid()) return Status::invalid_argument;
  if (!all_finite(quad)) return Status::non_finite;
  if (convex_hull(quad).empty()) return Status::degenerate;
  const ConvexPolygon<double> region = clip_to_image(quad, image.width(), image.height());
  const detail::PixelBox box = detail::pixel_box(region);
  if (box.empty()) return Status::too_few;

  const double most = static_cast<double>(options.max_pixels);
  const int coarse = (std::max)(static_cast<int>(std::sqrt(area(region) / most)), 1);
  const int fine = (std::max)(static_cast<int>(std::sqrt(area(region) / (2.0 * most))), 1);
  const auto grid = [&box](int cell) {
    return detail::CellGrid(box.x0, box.y0, box.x1 - box.x0, box.y1 - box.y0, cell);
  };

  std::vector<Corner> corners =
      detail::corners_in_region(image, region, box, options, options.max_pixels - options.max_pixels / 2);
  std::vector<Corner> chosen;
  detail::take_in_rounds(corners, grid(coarse), options.max_pixels, &chosen);
  detail::fill_by_gradient(image, region, box, grid(fine), options, &chosen);
  // Made at its full size: the function that grows a vector of a shared type is itself shared (see config.hpp).
  out = std::vector<Vector2<float>>(chosen.size());
  for (std::size_t i = 0; i < chosen.size(); ++i) out[i] = {chosen[i].x, chosen[i].y};
  return static_cast<int>(out.size()) < options.min_pixels ? Status::too_few : Status::ok;
}

/// The strongest corner of every square cell of `cell` px of a width x height image that holds no point of `occupied`,
/// strongest first (equal scores in raster order), at most `max_corners`. Corners and occupied points outside the image
/// are ignored. `out` is replaced; it is empty for sizes that are not positive. Allocates.
TEXTPLANE_DEFERRED
void select_spread(const std::vector<Corner>& corners, int width, int height, int cell, int max_corners,
                   const std::vector<Vector2<float>>& occupied, std::vector<Corner>& out) {
  std::vector<Corner> best;  // `out` may be `corners`
  if (width > 0 && height > 0 && cell > 0 && max_corners > 0) {
    const detail::CellGrid grid(0, 0, width, height, cell);
    std::vector<int> strongest(grid.size(), -1);
    constexpr int kOccupied = -2;
    for (const Vector2<float>& p : occupied)
      if (grid.contains(p[0], p[1])) strongest[grid.index(p[0], p[1])] = kOccupied;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      if (!grid.contains(corners[i].x, corners[i].y)) continue;
      int& s = strongest[grid.index(corners[i].x, corners[i].y)];
      if (s == -1 || (s >= 0 && corners[i].score > corners[static_cast<std::size_t>(s)].score)) s = static_cast<int>(i);
    }
    for (const int s : strongest)
      if (s >= 0) best.push_back(corners[static_cast<std::size_t>(s)]);
    detail::sort_by_score(&best);
    if (best.size() > static_cast<std::size_t>(max_corners)) best.resize(static_cast<std::size_t>(max_corners));
  }
  out.swap(best);
}

/// The patch of a text object: pixels selected on each of options.levels levels of its host image (fewer where the
/// pyramid has fewer), with their intensities. `quad`: px of level 0 of the image as it was taken; `camera`: the
/// host's. Status of patch_from_pixels(), or of select_pixels() where the finest level fails: a patch without level 0
/// is of no use; with options that are not valid() it is empty. Allocates.
TEXTPLANE_DEFERRED
TextPatch make_patch(const PyramidView& host, const CameraView& camera, const Quad<double>& quad,
                     const SelectOptions& options = {}) {
  if (!options.valid()) return {};
  const int levels = (std::min)({options.levels, host.levels, kMaxPyramidLevels});
  std::vector<std::vector<Vector2<float>>> pixels(static_cast<std::size_t>((std::max)(levels, 0)));
  Status finest = Status::invalid_argument;
  for (std::size_t l = 0; l < pixels.size(); ++l) {
    const Quad<double> level_quad = quad_to_level(quad, static_cast<int>(l));
    const Status status = select_pixels(host.level[l], level_quad, options, pixels[l]);
    if (l == 0) finest = status;
  }
  TextPatch patch = patch_from_pixels(host, camera, quad, pixels, options.min_pixels);
  if (is_ok(patch.status) && !is_ok(finest)) patch.status = finest;
  return patch;
}

/// The same from an image, of which a pyramid is built.
TEXTPLANE_DEFERRED
TextPatch make_patch(const ImageView8& host, const CameraView& camera, const Quad<double>& quad,
                     const SelectOptions& options = {}) {
  const Pyramid pyramid(host, (std::min)((std::max)(options.levels, 1), kMaxPyramidLevels));
  return make_patch(pyramid.view(), camera, quad, options);
}

TEXTPLANE_INSTANCE(Status select_pixels<>(const ImageView8&, const Quad<double>&, const SelectOptions&,
                                          std::vector<Vector2<float>>&));
TEXTPLANE_INSTANCE(TextPatch make_patch<>(const PyramidView&, const CameraView&, const Quad<double>&,
                                          const SelectOptions&));
TEXTPLANE_INSTANCE(TextPatch make_patch<>(const ImageView8&, const CameraView&, const Quad<double>&,
                                          const SelectOptions&));

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_FEATURES_SELECT_HPP
