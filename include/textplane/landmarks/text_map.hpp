// TextMap: text objects for a system that has its own poses and points.
//
//   TextMap texts(camera);
//   auto fit = texts.track(pyramid, T_c_w, points);            // each frame: fit.T_c_w
//   texts.add_keyframe(id, pyramid, T_c_w, quads, points);     // key frame
//   texts.move([&](int id) { return T_c_w_of(id); });          // after the host's adjustment
//   for (const TextObject& text : texts.objects()) ...
//
// A text becomes an object when key frames show it from different sides. A frame's pose is refined where the texts in
// view know it clearly better than the points do, and the points do not contradict; else the host's own pose comes
// back, to the bit. What is hidden, blurred, uncertain or wrong counts less, or not at all: TextFit tells.
//
// All poses are of world to camera. Images, quads and points are undistorted. Not thread-safe; no thread of its own;
// the same calls give the same results. Throws nothing but std::bad_alloc.
#ifndef TEXTPLANE_LANDMARKS_TEXT_MAP_HPP
#define TEXTPLANE_LANDMARKS_TEXT_MAP_HPP

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "textplane/landmarks/text_mapping.hpp"
#include "textplane/landmarks/text_pose.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// Why a text took part in a pose, or did not.
enum class TextUse : std::uint8_t {
  used,        ///< It took part.
  dissimilar,  ///< The image does not look like it, where it should be: hidden, blurred, or the pose is far off.
  disagrees,   ///< What it says of the pose contradicts the points or the other texts.
};

/// What one text in view did.
struct TextReport {
  int id = -1;                  ///< Of the object.
  TextUse use = TextUse::used;  ///< Whether it took part.
  double zncc = 0;              ///< At the pose returned.
  double share = 0;             ///< Of the information on the camera's position.
};

/// Result of TextMap::track().
struct TextFit {
  SE3d T_c_w;            ///< World to camera: refined, or the host's own to the bit.
  bool refined = false;  ///< Which of the two.
  FixedMatrix<double, 6, 6> information = FixedMatrix<double, 6, 6>::Zero();  ///< Of T_c_w, xi = (v, omega) left.
  double gain = 0;  ///< By how much the texts lower the standard deviation of the camera's position, as a share.
  int texts = 0;    ///< Texts that took part.
  Status status = Status::invalid_argument;  ///< ok; too_few: no text in view; diverged: texts and points disagree.
  std::vector<TextReport> reports;           ///< Of the mapped texts in view.
};

/// Settings of a TextMap.
struct TextMapOptions {
  TextOptions text;           ///< Of the life of a text.
  double min_zncc = 0.6;      ///< Of a text that takes part in a pose.
  double least_gain = 0.1;    ///< Of TextFit::gain; with less the host's pose stays as it is.
  double least_sigma = 0.25;  ///< px: points are not taken to be better.
  double most_shift = 2;      ///< Factor by which texts may raise the scale of the points' residuals.
  int max_images = 100;       ///< Key frames whose images are kept; of older ones the poses stay where texts need them.
};

/// See the head of this file.
TEXTPLANE_DEFERRED
class BasicTextMap {
 public:
  /// `camera`: of all images but those that are given with their own.
  explicit BasicTextMap(const Pinhole<double>& camera, const TextMapOptions& options = {})
      : camera_(camera), options_(options), mapping_(options_.text, store_) {}
  BasicTextMap(const BasicTextMap&) = delete;
  BasicTextMap& operator=(const BasicTextMap&) = delete;

  /// The pose of a frame, from the host's `T_c_w` (by its points, or predicted), by the mapped texts in view and the
  /// points with p_w. Without points the texts decide alone. Nothing of the map changes.
  TextFit track(const PyramidView& pyramid, const SE3d& T_c_w, const std::vector<TextPoint>& points) {
    return track(image_of(pyramid), T_c_w, points);
  }

  /// The same for an image with a camera of its own, as in a rig: T_c_w is of that camera.
  TextFit track(const TextImage& image, const SE3d& T_c_w, const std::vector<TextPoint>& points) {
    TextFit fit;
    fit.T_c_w = T_c_w;
    if (!all_finite(T_c_w) || image.pyramid.levels < 1 || !image.camera.valid()) return fit;
    points_.clear();
    for (const TextPoint& point : points)
      if (point.has_position && all_finite(point.p_w) && all_finite(point.px) && point.sigma > 0)
        points_.push_back({point.p_w, point.px, point.sigma});
    find_visible(image, T_c_w);
    fit.status = Status::too_few;
    if (visible_.empty()) return fit;

    // What the points say alone.
    const double scale = pose_.point_scale(points_, image.camera, T_c_w, options_.least_sigma);
    SE3d by_points = T_c_w;
    const bool has_points = points_.size() >= 6 && pose_.solve(points_, scale, visible_, image, &by_points);
    if (!has_points) by_points = T_c_w;
    const double alone = has_points ? position_sigma(pose_.information()) : 0;

    SE3d both = by_points;
    approach(image, scale, &both);
    for (FrameText& text : visible_) text.used = text.zncc >= options_.min_zncc;
    bool ok = pose_.solve(points_, scale, visible_, image, &both);
    bool changed = false;
    for (FrameText& text : visible_) {
      const bool good = text.used && text.zncc >= options_.min_zncc;
      changed |= good != text.used;
      text.used = good;
    }
    if (ok && changed) ok = pose_.solve(points_, scale, visible_, image, &both);
    for (const FrameText& text : visible_) {
      fit.texts += text.used ? 1 : 0;
      fit.reports.push_back({text.object->id, text.used ? TextUse::used : TextUse::dissimilar, text.zncc, text.share});
    }
    if (!ok || fit.texts == 0) {
      fit.texts = 0;
      return fit;
    }
    fit.gain = has_points ? 1 - position_sigma(pose_.information()) / alone : 1;
    if (fit.gain < options_.least_gain) return fit;
    if (has_points &&
        pose_.point_scale(points_, image.camera, both, options_.least_sigma) > options_.most_shift * scale) {
      for (TextReport& report : fit.reports)
        if (report.use == TextUse::used) report.use = TextUse::disagrees;
      fit.status = Status::diverged;
      fit.texts = 0;
      return fit;
    }
    fit.T_c_w = both;
    fit.information = pose_.information();
    fit.refined = true;
    fit.status = Status::ok;
    return fit;
  }

  /// A key frame: new texts, observations, planes, better hosts, and what is dropped. The host keeps the image until
  /// it calls remove_keyframe(id). invalid_argument for an id in use, an empty image or a camera that is not valid(),
  /// non_finite for such a pose; nothing changes then. Quads and points that are not finite are passed over.
  Status add_keyframe(int id, const PyramidView& pyramid, const SE3d& T_c_w, const std::vector<TextDetection>& quads,
                      const std::vector<TextPoint>& points) {
    return add(id, image_of(pyramid), nullptr, T_c_w, quads, points);
  }
  /// The same with an image that the map owns from here on.
  Status add_keyframe(int id, Pyramid&& pyramid, const SE3d& T_c_w, const std::vector<TextDetection>& quads,
                      const std::vector<TextPoint>& points) {
    auto own = std::make_unique<Pyramid>(std::move(pyramid));
    const PyramidView view = own->view();
    return add(id, image_of(view), std::move(own), T_c_w, quads, points);
  }

  /// The same for an image with a camera of its own, which the host keeps.
  Status add_keyframe(int id, const TextImage& image, const SE3d& T_c_w, const std::vector<TextDetection>& quads,
                      const std::vector<TextPoint>& points) {
    return add(id, image, nullptr, T_c_w, quads, points);
  }

  /// A key frame has left the host's map. Texts that it hosts move to their best other view, or are dropped.
  void remove_keyframe(int id) {
    if (!store_.has(id)) return;
    mapping_.keyframe_left(id);
    store_.erase(id);
  }

  /// Poses of the key frames anew: f(id) is that of world to camera. One that is not finite changes nothing. f is asked
  /// for the ids that texts or images still need, in their order.
  template <class PoseOf>
  void move(PoseOf f) {
    store_.move(f);
  }

  /// The texts of now, in the order of their ids. Valid until the next key frame is added or removed.
  const std::vector<TextObject>& objects() const noexcept { return mapping_.objects(); }
  const KeyframeStore& keyframes() const noexcept { return store_; }  ///< What it knows of the key frames.

  /// Its corners in the world, clockwise from the top left; false where it has no plane.
  bool corners(const TextObject& text, std::array<Vector3<double>, 4>* out) const {
    if (!text.has_plane() || !is_ok(quad_points(text.patch.quad, text.patch.camera, text.theta, out))) return false;
    const SE3d T_w_h = store_.text_keyframe(text.host).T_w_c;
    for (Vector3<double>& corner : *out) corner = T_w_h * corner;
    return true;
  }

 private:
  TextImage image_of(const PyramidView& pyramid) const {
    TextImage image;
    image.pyramid = pyramid;
    image.camera = camera_;
    return image;
  }

  Status add(int id, const TextImage& image, std::unique_ptr<Pyramid> own, const SE3d& T_c_w,
             const std::vector<TextDetection>& quads, const std::vector<TextPoint>& points) {
    if (image.pyramid.levels < 1 || !image.camera.valid()) return Status::invalid_argument;
    if (!all_finite(T_c_w)) return Status::non_finite;
    TextKeyframe keyframe;
    static_cast<TextImage&>(keyframe) = image;
    keyframe.T_w_c = T_c_w.inverse();
    if (!store_.add(id, keyframe, std::move(own))) return Status::invalid_argument;
    std::vector<TextDetection> finite_quads;
    std::vector<TextPoint> finite_points;
    for (const TextDetection& quad : quads)
      if (all_finite(quad.quad) && is_finite(quad.score)) finite_quads.push_back(quad);
    for (const TextPoint& point : points)
      if (all_finite(point.px) && all_finite(point.p_w) && is_finite(point.depth)) finite_points.push_back(point);
    mapping_.update(id, finite_quads, finite_points);
    store_.forget_oldest(options_.max_images, [this](int other) { return mapping_.needs(other); });
    return Status::ok;
  }

  void find_visible(const TextImage& image, const SE3d& T_c_w) {
    visible_.clear();
    for (const TextObject& text : mapping_.objects()) {
      if (text.state != TextState::mapped) continue;
      const SE3d T_w_h = store_.text_keyframe(text.host).T_w_c;
      Quad<double> quad;
      if (!text_in_view(options_.text, text, T_c_w * T_w_h, image, &quad)) continue;
      visible_.push_back({&text, T_w_h, scale_shift(text, quad)});
    }
  }

  // Coarse to fine, into the texts' basins.
  void approach(const TextImage& image, double scale, SE3d* T_c_w) {
    terms_.clear();
    for (const FrameText& text : visible_)
      terms_.push_back(
          {&text.object->patch, text.object->theta, text.T_w_h, 1 / text.object->variance_factor, text.scale_shift});
    const int n = static_cast<int>(terms_.size()), m = static_cast<int>(points_.size());
    workspace_.reserve(terms_.data(), n, m);
    zncc_.assign(visible_.size(), -1.0F);
    PoseOptions pose;
    pose.sigma_rep = scale;
    const PoseFit fit = refine_pose(terms_.data(), n, points_.data(), m, image.pyramid, image.camera, *T_c_w, pose,
                                    workspace_, zncc_.data(), nullptr);
    if (is_ok(fit.status)) *T_c_w = renormalised(fit.T_t_w);
    for (std::size_t i = 0; i < visible_.size(); ++i) visible_[i].zncc = static_cast<double>(zncc_[i]);
  }

  Pinhole<double> camera_;
  TextMapOptions options_;
  KeyframeStore store_;
  TextMapping mapping_;
  TextPose pose_;
  PoseWorkspace workspace_;
  std::vector<PosePointTerm> points_;
  std::vector<PoseTextTerm> terms_;
  std::vector<FrameText> visible_;
  std::vector<float> zncc_;
};
using TextMap = BasicTextMap<>;  ///< It is compiled only where it is used.

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_LANDMARKS_TEXT_MAP_HPP
