// Appearance: the form in which an object and an image are compared, robust to differences of light and sharpness.
//
// Both are normalised by local contrast (photometry/local_contrast.hpp), which the edge of a shadow or a highlight
// hardly changes. The object is kept at several degrees of blur, and an image out of focus or in motion is compared
// with the most similar one: otherwise the homography bends to explain the blur.
#ifndef TEXTPLANE_EXAMPLES_APPEARANCE_HPP
#define TEXTPLANE_EXAMPLES_APPEARANCE_HPP

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "textplane/photometry/blur.hpp"
#include "textplane/photometry/local_contrast.hpp"
#include "textplane/photometry/residual.hpp"
#include "textplane/photometry/template_patch.hpp"

namespace planar {

namespace tp = textplane;

struct AppearanceOptions {
  tp::LocalContrastOptions contrast;
  std::vector<double> blur = {0, 1, 3, 9};  ///< Variances of the blurs, px^2 of every level; 0 is the object itself.
  double gain = 0.02;                       ///< A stronger blur must raise ZNCC by this much.
  int margin = 16;                          ///< px of a level round the quad that are compared.
};

/// The part of one level that is compared, by local contrast; (x, y) is its corner in the level.
struct Window {
  tp::ImageView8 image;
  int x = 0, y = 0;

  /// The level's camera in px of the part.
  tp::Pinhole<double> of(tp::Pinhole<double> camera) const noexcept {
    camera.cx -= x;
    camera.cy -= y;
    return camera;
  }
};

class Appearance {
 public:
  Appearance() = default;
  /// `patch`: of the first image, on all levels of its pyramid.
  Appearance(const tp::PyramidView& first, const tp::TextPatch& patch, const AppearanceOptions& options)
      : options_(options), contrast_(options.contrast), looks_(std::max<std::size_t>(options.blur.size(), 1), patch) {
    for (std::size_t l = 0; l < patch.levels.size(); ++l) {
      const tp::Quad<double> quad = tp::quad_to_level(patch.quad, static_cast<int>(l));
      tp::Image<std::uint8_t> blurred(first.level[l].width(), first.level[l].height());
      for (std::size_t k = 0; k < looks_.size(); ++k) {
        tp::ImageView8 seen = first.level[l];
        if (k > 0) {
          const auto b = tp::bounds(quad);
          const int more = options.margin + options.contrast.radius + 2;
          tp::BlurFilter()(seen, tp::BlurKernel(options.blur[k] * tp::Matrix2d::Identity()),
                           static_cast<int>(b.min[0]) - more, static_cast<int>(b.min[1]) - more,
                           static_cast<int>(b.max[0]) + more, static_cast<int>(b.max[1]) + more, blurred.view());
          seen = blurred.view();
        }
        const Window at = window(seen, quad);
        if (at.image.valid()) tp::LocalContrast::take(at.image, at.x, at.y, &looks_[k].levels[l]);
      }
    }
    prepared_ = std::vector<tp::TemplatePatch>(patch.levels.size());
    for (std::size_t l = 0; l < prepared_.size(); ++l) prepared_[l].prepare(sharp().levels[l].view());
  }

  /// The object at the degree of blur 0, prepared for a search.
  const tp::TextPatch& sharp() const noexcept { return looks_[0]; }
  const tp::TemplatePatch* prepared() const noexcept { return prepared_.data(); }

  /// The number of degrees of blur, and one level of one of them.
  std::size_t count() const noexcept { return looks_.size(); }
  tp::PatchView look(std::size_t k, int level) const noexcept {
    return level < looks_[k].level_count() ? looks_[k].levels[static_cast<std::size_t>(level)].view() : tp::PatchView();
  }

  /// The degree of blur most similar to the image of `in` under a pose; of nearly equal ones the sharpest.
  std::size_t best(tp::PhotometricInput in, int level, const tp::Vector3<double>& theta, const tp::SE3d& T_t_h,
                   const tp::PhotometricOptions& photometric, tp::PhotometricWorkspace& workspace,
                   double* best_zncc) const noexcept {
    std::size_t found = 0;
    double zncc = -2;
    for (std::size_t k = 0; k < looks_.size(); ++k) {
      in.patch = look(k, level);
      const tp::PhotometricCost cost = tp::evaluate(tp::ResidualRequest{in, theta, T_t_h, photometric}, workspace);
      if (!tp::is_ok(cost.status) || !(cost.zncc > zncc + options_.gain)) continue;
      zncc = cost.zncc;
      found = k;
    }
    *best_zncc = zncc;
    return found;
  }

  /// The surroundings of a quad (px of the level) in an image, valid until the next call; not valid() where the quad is
  /// out of view.
  Window window(const tp::ImageView8& image, const tp::Quad<double>& quad) {
    const auto b = tp::bounds(quad);
    const auto cut = [](double v, int most) { return static_cast<int>(std::min(std::max(v, 0.0), 1.0 * most)); };
    const int x0 = cut(b.min[0] - options_.margin, image.width()), y0 = cut(b.min[1] - options_.margin, image.height());
    const int x1 = cut(b.max[0] + options_.margin + 1, image.width());
    const int y1 = cut(b.max[1] + options_.margin + 1, image.height());
    if (x1 <= x0 || y1 <= y0) return {};
    const std::size_t size = static_cast<std::size_t>(x1 - x0) * static_cast<std::size_t>(y1 - y0);
    if (pixels_.size() < size) pixels_.resize(size);
    const tp::ImageView<std::uint8_t> to(pixels_.data(), x1 - x0, y1 - y0);
    if (!tp::is_ok(contrast_(image, x0, y0, to))) return {};
    return {to, x0, y0};
  }

 private:
  AppearanceOptions options_;
  tp::LocalContrast contrast_;
  std::vector<tp::TextPatch> looks_;
  std::vector<tp::TemplatePatch> prepared_;
  std::vector<std::uint8_t> pixels_;
};

}  // namespace planar

#endif  // TEXTPLANE_EXAMPLES_APPEARANCE_HPP
