// ViewSearch: finds an object anywhere in an image, by ZNCC with the views of it that a tracker remembers.
//
// Every view, turned and zoomed in steps, is compared at every place of one coarse level, on local contrast. The level
// is that where the view is still a few letters large. The steps follow from its size there: what lies between two of
// them must still overlap its strokes. What is found is a start for a fit, not a pose.
#ifndef TEXTPLANE_EXAMPLES_VIEW_SEARCH_HPP
#define TEXTPLANE_EXAMPLES_VIEW_SEARCH_HPP

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "planar/pose_plane_problem.hpp"
#include "textplane/features/select.hpp"
#include "textplane/geometry/quad_projection.hpp"
#include "textplane/photometry/candidates.hpp"
#include "textplane/photometry/local_contrast.hpp"

namespace planar {

namespace tp = textplane;

struct ViewSearchOptions {
  double side = 18;       ///< px: about the square root of a view's area on the level that is searched.
  int pixels = 150;       ///< Of the object that are compared.
  int levels = 6;         ///< Pyramid levels that it may choose from.
  double step = 1.5;      ///< px of the level, between places.
  double move = 2;        ///< px of the level that a view's ends move by, between turns and between zooms.
  double turn = 0.4;      ///< rad, to either side.
  double zoom = 1.4;      ///< To either side.
  double squeeze = 1.06;  ///< Views differ that are squeezed by more: (s + 1 / s) / 2 of the ratio s of both axes.
  double least = 0.3;     ///< Places of a lower ZNCC are no start.
  tp::PhotometricOptions photometric;  ///< Of every pixel.
  std::size_t keep = 24;               ///< Starts at most.
};

/// Whether one view is found by the other: they differ by little but place, turn and zoom within the steps of a search.
inline bool alike(const tp::Quad<double>& a, const tp::Quad<double>& b, const ViewSearchOptions& options) noexcept {
  tp::Matrix2d A, B;
  A << a.corner[2] - a.corner[0], a.corner[3] - a.corner[1];
  B << b.corner[2] - b.corner[0], b.corner[3] - b.corner[1];
  const tp::Matrix2d M = B * A.inverse();
  const double det = M.determinant(), trace = M.squaredNorm();
  if (!(det > 0)) return false;
  const double turn = std::atan2(M(1, 0) - M(0, 1), M(0, 0) + M(1, 1));
  const double squeeze = trace / (2 * det);  // (s + 1 / s) / 2 of the ratio s of the singular values
  return squeeze < options.squeeze && std::abs(turn) < options.turn &&
         std::abs(std::log(det)) < 2 * std::log(options.zoom);
}

/// The part of an image that the object's centre is searched in, px.
struct Region {
  double x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};

/// Where a view was found.
struct Place {
  PlaneState state;
  double x = 0, y = 0;  ///< px of level 0: the centre.
  double turn = 0;      ///< rad, of the view.
  float zncc = -1;
};

class ViewSearch {
 public:
  ViewSearch() = default;
  /// `first`: the pyramid of the object's image.
  ViewSearch(const tp::PyramidView& first, const tp::Pinhole<double>& camera, const tp::Quad<double>& quad,
             const ViewSearchOptions& options, const tp::LocalContrastOptions& contrast)
      : options_(options), camera_(camera), contrast_(contrast) {
    tp::SelectOptions select;
    select.max_pixels = options.pixels;
    select.levels = options.levels;
    patch_ = tp::make_patch(first, camera, quad, select);
    prepared_ = std::vector<tp::TemplatePatch>(patch_.levels.size());
    for (std::size_t l = 0; l < patch_.levels.size(); ++l) {
      const tp::ImageView8 seen = contrasted(first.level[l]);
      if (seen.valid()) tp::LocalContrast::take(seen, 0, 0, &patch_.levels[l]);
      prepared_[l].prepare(patch_.levels[l].view());
    }
    workspace_.reserve(patch_.max_pixels());
  }

  /// Starts with their centre in a region, best first, at most one of nearly equal ones. The views are turned about
  /// `turn` and options.turn to both sides of it.
  std::vector<Place> operator()(const tp::PyramidView& image, const std::vector<PlaneState>& views,
                                const Region& region, double turn) {
    std::vector<Place> found;
    int contrasted_level = -1;
    for (const PlaneState& view : views) {
      tp::Quad<double> seen;
      if (!tp::is_ok(tp::transform(patch_.quad,
                                   tp::pixel_homography(tp::plane_homography(view.theta, view.T_t_h), camera_, camera_),
                                   &seen)))
        continue;
      if (!(tp::area(seen) > options_.side * options_.side)) continue;
      const int host = level_of(tp::area(patch_.quad), patch_.level_count());
      const int level = level_of(tp::area(seen), image.levels);
      if (host < 0 || level < 0) continue;
      if (level != contrasted_level) target_ = contrasted(image.level[static_cast<std::size_t>(level)]);
      contrasted_level = level;
      if (!target_.valid()) continue;
      const tp::PhotometricInput in{patch_.levels[static_cast<std::size_t>(host)].view(), camera_.at_level(host),
                                    camera_.at_level(level), target_};
      // Where less than half of the object is in view, chance finds too much.
      const auto b = tp::bounds(seen);
      const double mx = 0.25 * (b.max[0] - b.min[0]), my = 0.25 * (b.max[1] - b.min[1]);
      const double right = std::ldexp(target_.width(), level), bottom = std::ldexp(target_.height(), level);
      const Region inner{std::max(region.x0, mx), std::max(region.y0, my), std::min(region.x1, right - mx),
                         std::min(region.y1, bottom - my)};
      const double reach = std::ldexp(std::max(b.max[0] - b.min[0], b.max[1] - b.min[1]) / 2, -level) / options_.move;
      const int turns = static_cast<int>(std::ceil(options_.turn * reach));
      const int zooms = static_cast<int>(std::ceil(std::log(options_.zoom) * reach));
      for (int t = -turns; t <= turns; ++t)
        for (int z = -zooms; z <= zooms; ++z)
          scan(in, prepared_[static_cast<std::size_t>(host)], view, inner, level, turn + t * options_.turn / turns,
               std::pow(options_.zoom, static_cast<double>(z) / zooms), found);
    }
    return best_of(found);
  }

 private:
  int level_of(double area, int levels) const noexcept {
    if (!(area > 0)) return -1;
    const double octaves = std::round(std::log2(std::sqrt(area) / options_.side));
    return static_cast<int>(std::min(std::max(octaves, 0.0), levels - 1.0));
  }

  tp::ImageView8 contrasted(const tp::ImageView8& image) {
    const std::size_t size = static_cast<std::size_t>(image.width()) * static_cast<std::size_t>(image.height());
    if (pixels_.size() < size) pixels_.resize(size);
    const tp::ImageView<std::uint8_t> to(pixels_.data(), image.width(), image.height());
    return tp::is_ok(contrast_(image, 0, 0, to)) ? tp::ImageView8(to) : tp::ImageView8();
  }

  // All places of one view, turned and zoomed: those that no neighbour exceeds go to `found`.
  void scan(const tp::PhotometricInput& in, const tp::TemplatePatch& prepared, const PlaneState& view,
            const Region& region, int level, double turn, double zoom, std::vector<Place>& found) {
    const tp::Vector3<double> host = camera_.unproject(tp::centroid(patch_.quad));
    const double rho = view.theta.dot(host);
    if (!(rho > 0)) return;
    const tp::Vector3<double> centre = view.T_t_h.R * host / rho + view.T_t_h.t;
    const tp::Matrix3<double> roll = tp::so3_exp<double>(tp::Vector3<double>(0, 0, turn));
    const double step = std::ldexp(options_.step, level);
    const int columns = static_cast<int>((region.x1 - region.x0) / step) + 1;
    const int rows = static_cast<int>((region.y1 - region.y0) / step) + 1;
    if (columns < 1 || rows < 1) return;
    const auto n = static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
    poses_.resize(n);
    zncc_.resize(n);
    for (std::size_t i = 0; i < n; ++i) {
      const tp::Vector2<double> px(region.x0 + step * static_cast<double>(i % static_cast<std::size_t>(columns)),
                                   region.y0 + step * static_cast<double>(i / static_cast<std::size_t>(columns)));
      poses_[i].R = roll * view.T_t_h.R;
      poses_[i].t = roll * (view.T_t_h.t - centre) + centre[2] / zoom * camera_.unproject(px);
    }
    tp::zncc_candidates(in, view.theta, poses_.data(), static_cast<int>(n), options_.photometric, workspace_,
                        zncc_.data(), &prepared);
    for (int y = 0; y < rows; ++y)
      for (int x = 0; x < columns; ++x) {
        const auto i = static_cast<std::size_t>(y * columns + x);
        if (zncc_[i] < options_.least || !is_peak(x, y, columns, rows)) continue;
        found.push_back({{poses_[i], view.theta}, region.x0 + step * x, region.y0 + step * y, turn, zncc_[i]});
      }
  }

  bool is_peak(int x, int y, int columns, int rows) const noexcept {
    const float here = zncc_[static_cast<std::size_t>(y * columns + x)];
    for (int v = std::max(y - 1, 0); v <= std::min(y + 1, rows - 1); ++v)
      for (int u = std::max(x - 1, 0); u <= std::min(x + 1, columns - 1); ++u)
        if (zncc_[static_cast<std::size_t>(v * columns + u)] > here) return false;
    return true;
  }

  std::vector<Place> best_of(std::vector<Place>& found) const {
    std::stable_sort(found.begin(), found.end(), [](const Place& a, const Place& b) { return a.zncc > b.zncc; });
    std::vector<Place> out;
    const double apart = 0.15 * std::sqrt(tp::area(patch_.quad)), turned = 0.75 * options_.turn;
    for (const Place& f : found) {
      if (out.size() >= options_.keep) break;
      if (std::none_of(out.begin(), out.end(), [&](const Place& o) {
            return std::hypot(f.x - o.x, f.y - o.y) < apart && std::abs(f.turn - o.turn) < turned;
          }))
        out.push_back(f);
    }
    return out;
  }

  ViewSearchOptions options_;
  tp::Pinhole<double> camera_;
  tp::LocalContrast contrast_;
  tp::TextPatch patch_;
  std::vector<tp::TemplatePatch> prepared_;
  std::vector<std::uint8_t> pixels_;
  tp::ImageView8 target_;
  tp::PhotometricWorkspace workspace_;
  std::vector<tp::SE3d> poses_;
  std::vector<float> zncc_;
};

}  // namespace planar

#endif  // TEXTPLANE_EXAMPLES_VIEW_SEARCH_HPP
