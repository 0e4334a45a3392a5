#include "textslam/relocalise/text_hypotheses.hpp"

#include <algorithm>

#include "sign_index/planar_pose.hpp"
#include "textplane/geometry/quad.hpp"
#include "textplane/geometry/quad_projection.hpp"
#include "textplane/landmarks/text_noise.hpp"
#include "textplane/landmarks/words.hpp"
#include "textplane/solver/pose.hpp"
#include "textplane/solver/search.hpp"
#include "textslam/map/text_views.hpp"

namespace textslam {
namespace {

bool is_match(const std::string& a, const std::string& b, WordMatch match) {
  const bool read = is_read(a) && is_read(b), same = read && a == b;
  return match == WordMatch::same ? same : match == WordMatch::unread ? !read : !same;
}

class TextSearch {
 public:
  TextSearch(const Map& map, const Parameters& parameters, const Frame& frame)
      : map_(map), parameters_(parameters), frame_(frame) {}

  void compare(const Detection& detection, const TextObject& text) {
    std::array<Vec3, 4> corners, rays;
    if (!textplane::is_ok(textplane::text_corners(text, &corners)) || !rays_of(map_.camera, detection.quad, &rays))
      return;
    Quad<double> image;
    for (std::size_t i = 0; i < 4; ++i) image.corner[i] = rays[i].hnormalized();
    const PlanarPose pose = planar_pose(corners, image);
    for (int i = 0; i < pose.count; ++i) {
      const SE3d T_w_h = map_.keyframe(text.host).T_w_c;
      add(text, pose.T_c_q[static_cast<std::size_t>(i)] * T_w_h.inverse());
    }
  }

  std::vector<TextHypothesis> best() {
    std::stable_sort(found_.begin(), found_.end(), [](const TextHypothesis& a, const TextHypothesis& b) {
      return a.confirmed != b.confirmed ? a.confirmed > b.confirmed : a.zncc > b.zncc;
    });
    if (found_.size() > static_cast<std::size_t>(parameters_.relocalise_hypotheses))
      found_.resize(static_cast<std::size_t>(parameters_.relocalise_hypotheses));
    return std::move(found_);
  }

 private:
  void add(const TextObject& text, const SE3d& guess) {
    TextHypothesis hypothesis;
    hypothesis.text = text.id;
    hypothesis.T_c_w = guess;
    if (!search(text, &hypothesis.T_c_w) || !refine(text, &hypothesis)) return;
    // The two solutions may differ by little in the image: it is the pose that tells them apart.
    for (const TextHypothesis& other : found_) {
      const Eigen::Matrix3d turn = other.T_c_w.R * hypothesis.T_c_w.R.transpose();
      if (other.text == text.id && textplane::so3_log(turn).norm() < radians(parameters_.relocalise_same_pose)) return;
    }
    hypothesis.confirmed = confirmed(hypothesis.T_c_w);
    found_.push_back(hypothesis);
  }

  bool search(const TextObject& text, SE3d* T_c_w) {
    if (is_too_slanted(parameters_.text, facing(map_, text, *T_c_w))) return false;
    const SE3d T_w_h = map_.keyframe(text.host).T_w_c;
    photometric_.reserve(text.patch.max_pixels());
    textplane::SearchOptions options;
    options.level = parameters_.relocalise_search_level;
    float zncc = -1;
    const SE3d T_c_h = textplane::search_pose(text.patch, text.theta, *T_c_w * T_w_h, frame_.image->view(), map_.camera,
                                              options, photometric_, nullptr, &zncc);
    *T_c_w = T_c_h * T_w_h.inverse();
    return zncc >= parameters_.relocalise_search_zncc;
  }

  bool refine(const TextObject& text, TextHypothesis* hypothesis) {
    Quad<double> quad;
    if (!project_text(map_, text, hypothesis->T_c_w, &quad)) return false;
    const textplane::PoseTextTerm term{&text.patch, text.theta, map_.keyframe(text.host).T_w_c, 1,
                                       scale_shift(text, quad)};
    pose_.reserve(&term, 1, 0);
    textplane::PoseOptions options;
    options.sigma_photo = parameters_.photometric_sigma;
    options.coarsest_level = parameters_.text.levels - 1;
    const auto fit = textplane::refine_pose(&term, 1, nullptr, 0, frame_.image->view(), map_.camera, hypothesis->T_c_w,
                                            options, pose_);
    if (fit.texts != 1) return false;
    const double least =
        text_zncc_limit(parameters_.text, parameters_.text.min_zncc, text.patch, 0, text.theta,
                        map_.text_keyframe(text.host), map_.text_image(frame_), map_.T_c_h(fit.T_t_w, text.host));
    if (fit.zncc < least) return false;
    hypothesis->T_c_w = textplane::renormalised(fit.T_t_w);
    hypothesis->zncc = fit.zncc;
    return true;
  }

  int confirmed(const SE3d& T_c_w) const {
    int count = 0;
    for (const Detection& detection : frame_.detections)
      count += std::any_of(map_.texts.begin(), map_.texts.end(), [&](const TextObject& text) {
        Quad<double> quad;
        return text.state == TextState::mapped && facing(map_, text, T_c_w) > 0 &&
               project_text(map_, text, T_c_w, &quad) &&
               textplane::iou(quad, detection.quad) >= parameters_.text_shown_iou;
      });
    return count;
  }

  const Map& map_;
  const Parameters& parameters_;
  const Frame& frame_;
  textplane::PhotometricWorkspace photometric_;
  textplane::PoseWorkspace pose_;
  std::vector<TextHypothesis> found_;
};

}  // namespace

std::vector<TextHypothesis> text_hypotheses(const Map& map, const Parameters& parameters, const Frame& frame,
                                            WordMatch words) {
  TextSearch search(map, parameters, frame);
  for (const Detection& detection : frame.detections) {
    if (!textplane::is_convex(detection.quad) || textplane::area(detection.quad) < parameters.text.min_area) continue;
    for (const TextObject& text : map.texts) {
      if (text.state != TextState::mapped) continue;
      if (is_match(detection.text, textplane::consensus(text.votes), words)) search.compare(detection, text);
    }
  }
  return search.best();
}

}  // namespace textslam
