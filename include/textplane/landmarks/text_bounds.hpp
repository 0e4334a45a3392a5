// TextBounds: spheres about the mapped texts in the world, so that a frame looks only at those that it may show.
//
// Few of a large map's texts are in a camera's view. Those of one part of its world follow one another, as they came to
// be mapped, so that most are left out sixteen at a time. What the spheres let through, text_in_view() decides.
#ifndef TEXTPLANE_LANDMARKS_TEXT_BOUNDS_HPP
#define TEXTPLANE_LANDMARKS_TEXT_BOUNDS_HPP

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "textplane/geometry/quad_projection.hpp"
#include "textplane/landmarks/keyframe_store.hpp"
#include "textplane/landmarks/text_object.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// The spheres of the mapped texts of a TextMap, and the poses of their hosts.
TEXTPLANE_DEFERRED
class BasicTextBounds {
 public:
  /// Of the texts from `first` on anew, all by default: after a change of theirs or of their hosts' poses.
  void update(const std::vector<TextObject>& texts, const KeyframeStore& keyframes, std::size_t first = 0) {
    if (first == 0) {
      spheres_.clear();
      blocks_.clear();
      texts_.clear();
    }
    for (std::size_t i = first; i < texts.size(); ++i)
      if (texts[i].state == TextState::mapped) add(i, texts[i], keyframes.text_keyframe(texts[i].host).T_w_c);
  }

  /// Of one text anew, after a change of its plane alone.
  void update_plane(std::size_t index, const TextObject& text) {
    const auto at = std::lower_bound(texts_.begin(), texts_.end(), index,
                                     [](const Text& other, std::size_t i) { return other.index < i; });
    if (at == texts_.end() || at->index != index) return;  // not mapped
    const auto place = static_cast<std::size_t>(at - texts_.begin());
    spheres_[place] = sphere_about(text, at->T_w_h);
    enclose(spheres_[place], &blocks_[place / kBlock]);
  }

  /// Calls f(index, T_w_h) for the texts, in their order, that may reach into the image; T_c_w is its pose.
  template <class Visit>
  void for_each_near(const TextImage& image, const SE3d& T_c_w, Visit f) const {
    const View view(image, T_c_w);
    for (std::size_t first = 0; first < spheres_.size(); first += kBlock) {
      if (view.misses(blocks_[first / kBlock])) continue;
      const std::size_t end = (std::min)(first + kBlock, spheres_.size());
      for (std::size_t i = first; i < end; ++i)
        if (!view.misses(spheres_[i])) f(texts_[i].index, texts_[i].T_w_h);
    }
  }

 private:
  static constexpr std::size_t kBlock = 16;

  struct Sphere {
    Vector3<Real> centre;  // in the world
    double radius = 0;
  };
  struct Text {
    std::size_t index = 0;
    SE3d T_w_h;
  };

  static Sphere sphere_about(const TextObject& text, const SE3d& T_w_h) {
    std::array<Vector3<Real>, 4> corners;
    // A text without a place in its host counts as everywhere.
    if (!is_ok(quad_points(text.patch.quad, text.patch.camera, text.theta, &corners)))
      return {Vector3<Real>::Zero(), std::numeric_limits<double>::infinity()};
    Vector3<Real> centre = Vector3<Real>::Zero();
    for (const Vector3<Real>& corner : corners) centre += 0.25 * corner;
    double radius = 0;
    for (const Vector3<Real>& corner : corners) radius = (std::max)(radius, (corner - centre).norm());
    return {T_w_h * centre, radius};
  }

  static void enclose(const Sphere& sphere, Sphere* block) {
    block->radius = (std::max)(block->radius, (sphere.centre - block->centre).norm() + sphere.radius);
  }

  void add(std::size_t index, const TextObject& text, const SE3d& T_w_h) {
    const Sphere sphere = sphere_about(text, T_w_h);
    if (spheres_.size() % kBlock == 0) blocks_.push_back(sphere);
    enclose(sphere, &blocks_.back());
    spheres_.push_back(sphere);
    texts_.push_back({index, T_w_h});
  }

  // The pyramid of view, one px wider than the image (behind a lens that of its corners and the middles of its sides,
  // and a tenth wider), and the half space before the camera.
  class View {
   public:
    View(const TextImage& image, const SE3<Real>& T_c_w) noexcept {
      const Pinhole<Real>& camera = image.camera.pinhole;
      double left = camera.cx + 1, right = image.width() - camera.cx, top = camera.cy + 1,
             bottom = image.height() - camera.cy;
      sides_ = !image.camera.lens || widen(image, &left, &right, &top, &bottom) ? kSides : 1;
      const Vector3<Real> inward[] = {
          {0, 0, 1}, {camera.fx, 0, left}, {-camera.fx, 0, right}, {0, camera.fy, top}, {0, -camera.fy, bottom}};
      for (std::size_t k = 0; k < sides_; ++k) {
        const Vector3<Real> n = inward[k].normalized();
        normal_[k] = T_c_w.R.transpose() * n;
        offset_[k] = n.dot(T_c_w.t);
      }
    }

    bool misses(const Sphere& sphere) const noexcept {
      const Vector3<Real>& c = sphere.centre;
      for (std::size_t k = 0; k < sides_; ++k) {
        const Vector3<Real>& n = normal_[k];
        if (n[0] * c[0] + n[1] * c[1] + n[2] * c[2] + offset_[k] < -sphere.radius) return true;
      }
      return false;
    }

   private:
    // How far the undistorted image reaches from the principal point, px. False where a ray of the border has no place
    // in it.
    static bool widen(const TextImage& image, double* left, double* right, double* top, double* bottom) noexcept {
      const Pinhole<Real>& camera = image.camera.pinhole;
      *left = *right = *top = *bottom = 0;
      for (int k = 0; k < 9; ++k) {
        if (k == 4) continue;
        Vector3<Real> ray;
        const Vector2<Real> px(0.5 * (k % 3) * (image.width() - 1), 0.5 * (k / 3) * (image.height() - 1));
        if (!is_ok(image.camera.unproject(px, &ray))) return false;
        constexpr double kWider = 1.1;
        *left = (std::max)(*left, -kWider * camera.fx * ray.x());
        *right = (std::max)(*right, kWider * camera.fx * ray.x());
        *top = (std::max)(*top, -kWider * camera.fy * ray.y());
        *bottom = (std::max)(*bottom, kWider * camera.fy * ray.y());
      }
      return true;
    }

    static constexpr std::size_t kSides = 5;
    std::size_t sides_ = kSides;
    Vector3<Real> normal_[kSides];
    double offset_[kSides];
  };

  std::vector<Sphere> spheres_, blocks_;  // a block is of kBlock spheres
  std::vector<Text> texts_;
};
using TextBounds = BasicTextBounds<>;  ///< It is compiled only where it is used.

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_LANDMARKS_TEXT_BOUNDS_HPP
