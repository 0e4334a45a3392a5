#include "textslam/adjust/adjustment.hpp"

#include <algorithm>

#include "textplane/landmarks/text_plane.hpp"
#include "textplane/solver/window.hpp"
#include "textslam/adjust/adjustment_selection.hpp"
#include "textslam/common/algorithms.hpp"
#include "textslam/map/observations.hpp"
#include "textslam/map/text_views.hpp"

namespace textslam {
namespace {

class Adjustment {
 public:
  Adjustment(const Map& map, const Parameters& parameters, const AdjustmentSelection& selection, int text_views)
      : parameters_(parameters), text_views_(static_cast<std::size_t>(text_views)) {
    slot_of_.assign(map.keyframes.size(), -1);
    window_.camera = map.camera;
    for (const int id : selection.free_frames) add_frame(map, id, false);
    for (const int id : selection.fixed_frames) add_frame(map, id, true);
    if (selection.scale_frame >= 0) {
      scale_frame_a_ = slot_of_[static_cast<std::size_t>(selection.fixed_frames[0])];
      scale_frame_b_ = slot_of_[static_cast<std::size_t>(selection.scale_frame)];
    }
    for (const int id : selection.points) add_point(map, id);
    patches_.reserve(map.texts.size());  // the window points to them
    if (parameters.mode == Mode::text)
      for (const TextObject& text : map.texts) add_text(map, text);
  }

  void solve(int iterations) {
    textplane::WindowOptions options;
    options.sigma_photo = parameters_.photometric_sigma;
    options.max_iterations = iterations;
    options.scale_frame_a = scale_frame_a_;
    options.scale_frame_b = scale_frame_b_;
    textplane::WindowWorkspace workspace;
    textplane::solve_window(window_, options, workspace);
  }

  // Observations of a text weigh by the inverse variance of a pixel's residual, 1 - zncc up to a factor: sharp views
  // weigh more than blurred ones. Their sum stays the same.
  void weigh_texts(const Map& map) {
    std::vector<double> sums(texts_.size(), 0), counts(texts_.size(), 0);
    textplane::PhotometricWorkspace workspace;
    for (textplane::WindowTextObservation& o : window_.text_observations) {
      const auto slot = static_cast<std::size_t>(o.text);
      const TextObject& text = map.text(texts_[slot]);
      const textplane::TextKeyframe keyframe = map.text_keyframe(frames_[static_cast<std::size_t>(o.frame)]);
      const SE3d T_t_h = keyframe.from(map.text_keyframe(text.host));
      const auto cost = compare_text(text, 0, keyframe, T_t_h, o.scale_shift, workspace);
      o.weight = 1 / std::max(parameters_.window_min_variance, 1 - (textplane::is_ok(cost.status) ? cost.zncc : 0));
      sums[slot] += o.weight;
      ++counts[slot];
    }
    for (textplane::WindowTextObservation& o : window_.text_observations) {
      const auto slot = static_cast<std::size_t>(o.text);
      o.weight *= counts[slot] / sums[slot];
    }
  }

  void write_back(Map& map) const {
    for (std::size_t i = 0; i < frames_.size(); ++i) {
      map.keyframe(frames_[i]).T_w_c = textplane::renormalised(window_.frames[i].T_w_c);
      if (rows_[i])
        map.set_rows(frames_[i], std::make_shared<const textplane::RowMotion>(
                                     textplane::RowMotion{window_.frames[i].velocity, rows_[i]->shutter}));
    }
    for (std::size_t i = 0; i < points_.size(); ++i) map.point(points_[i]).p_w = window_.points[i].p_w;
  }

  // After all key frames of the map have their poses: a text may have another host by now, one that came later.
  void write_back_texts(Map& map) const {
    for (std::size_t i = 0; i < texts_.size(); ++i) {
      TextObject& text = map.text(texts_[i]);
      const textplane::WindowText& adjusted = window_.texts[i];
      if (text.state != TextState::mapped || !textplane::is_ok(adjusted.status)) continue;
      Vec3 theta = adjusted.theta;
      Eigen::Matrix3d covariance = adjusted.covariance;
      const int host = frames_[static_cast<std::size_t>(adjusted.host)];
      if (text.host != host &&
          !textplane::transport_plane(map.text_keyframe(text.host).from(map.text_keyframe(host)), &theta, &covariance))
        continue;
      text.theta = theta;
      text.covariance = covariance;
      text.zncc = adjusted.zncc;
    }
  }

  int remove_outliers(Map& map) const {
    int removed = 0;
    for (const textplane::WindowPointObservation& o : window_.point_observations) {
      const int point = points_[static_cast<std::size_t>(o.point)];
      if (o.chi2 <= parameters_.window_outlier_factor * parameters_.outlier_chi2 || map.point(point).bad) continue;
      remove_observation(map, point, frames_[static_cast<std::size_t>(o.frame)]);
      ++removed;
    }
    return removed;
  }

 private:
  void add_frame(const Map& map, int id, bool fixed) {
    slot_of_[static_cast<std::size_t>(id)] = static_cast<int>(frames_.size());
    frames_.push_back(id);
    images_.push_back(map.keyframe(id).frame.image);
    rows_.push_back(map.keyframe(id).frame.rows);
    window_.frames.push_back({map.keyframe(id).T_w_c, fixed, images_.back()->view(), rows_.back().get()});
    textplane::WindowFrame& frame = window_.frames.back();
    if (!frame.rows) return;
    frame.velocity_sigma.head<3>().setConstant(parameters_.row_speed_sigma);
    frame.velocity_sigma.tail<3>().setConstant(parameters_.row_turn_sigma);
  }

  void add_point(const Map& map, int id) {
    const MapPoint& point = map.point(id);
    int usable = 0;
    for (const PointObservation& o : point.observations) usable += slot_of_[static_cast<std::size_t>(o.keyframe)] >= 0;
    if (usable < 2) return;
    for (const PointObservation& o : point.observations) {
      const int slot = slot_of_[static_cast<std::size_t>(o.keyframe)];
      if (slot < 0) continue;
      window_.point_observations.push_back(
          {slot, static_cast<int>(points_.size()), o.px, parameters_.window_point_sigma});
    }
    window_.points.push_back({point.p_w});
    points_.push_back(id);
  }

  void add_text(const Map& map, const TextObject& text) {
    if (text.state != TextState::mapped || slot_of_[static_cast<std::size_t>(text.host)] < 0) return;
    std::vector<int> usable;
    for (const int id : text.views)
      if (slot_of_[static_cast<std::size_t>(id)] >= 0) usable.push_back(id);
    if (usable.empty()) return;
    for (const int id : evenly_spaced(usable, text_views_)) {
      Quad<double> quad;
      const int shift = project_text(map, text, map.keyframe(id).T_w_c.inverse(), &quad) ? scale_shift(text, quad) : 0;
      const int slot = slot_of_[static_cast<std::size_t>(id)];
      window_.text_observations.push_back({static_cast<int>(texts_.size()), slot, 1, shift});
    }
    patches_.push_back(text.patch);
    window_.texts.push_back({slot_of_[static_cast<std::size_t>(text.host)], text.theta, &patches_.back()});
    texts_.push_back(text.id);
  }

  const Parameters& parameters_;
  std::size_t text_views_;                       // at most, of a text
  int scale_frame_a_ = -1, scale_frame_b_ = -1;  // of the window
  textplane::Window window_;
  std::vector<std::shared_ptr<const Pyramid>> images_;             // of the window's frames
  std::vector<std::shared_ptr<const textplane::RowMotion>> rows_;  // likewise
  std::vector<textplane::TextPatch> patches_;                      // of its texts
  std::vector<int> slot_of_;                                       // key frame id -> frame of the window, -1: not in it
  std::vector<int> frames_, points_, texts_;                       // index in the window -> id
};

class StagedWindow : public StagedAdjustment {
 public:
  StagedWindow(const Map& map, const Parameters& parameters, const AdjustmentSelection& selection)
      : adjustment_(map, parameters, selection, parameters.text.views),
        iterations_(parameters.window_iterations),
        newest_(map.newest_keyframe()),
        points_(map.points.size()),
        T_w_c_(map.keyframe(newest_).T_w_c) {}

  void solve() override { adjustment_.solve(iterations_); }

  SE3d apply(Map& map) const override {
    adjustment_.write_back(map);
    adjustment_.remove_outliers(map);
    const SE3d moved = map.keyframe(newest_).T_w_c * T_w_c_.inverse();
    for (std::size_t i = static_cast<std::size_t>(newest_) + 1; i < map.keyframes.size(); ++i)
      map.keyframes[i].T_w_c = textplane::renormalised(moved * map.keyframes[i].T_w_c);
    for (std::size_t i = points_; i < map.points.size(); ++i) map.points[i].p_w = moved * map.points[i].p_w;
    adjustment_.write_back_texts(map);
    return moved;
  }

 private:
  Adjustment adjustment_;
  int iterations_;
  int newest_;          // key frame
  std::size_t points_;  // of the map, when it was prepared
  SE3d T_w_c_;          // of the newest key frame then
};

}  // namespace

std::unique_ptr<StagedAdjustment> StagedAdjustment::around_newest(const Map& map, const Parameters& parameters) {
  if (is_too_young(map)) return nullptr;
  const AdjustmentSelection selection = local_selection(map, parameters);
  if (selection.free_frames.empty()) return nullptr;
  return std::make_unique<StagedWindow>(map, parameters, selection);
}

std::unique_ptr<StagedAdjustment> StagedAdjustment::of_all(const Map& map, const Parameters& parameters) {
  if (map.keyframe_ids().size() < 3) return nullptr;
  return std::make_unique<StagedWindow>(map, parameters, whole_selection(map, parameters));
}

void adjust_local(Map& map, const Parameters& parameters) {
  if (is_too_young(map)) return adjust_all(map, parameters, parameters.window_iterations);
  const auto adjustment = StagedAdjustment::around_newest(map, parameters);
  if (!adjustment) return;
  adjustment->solve();
  adjustment->apply(map);
}

void adjust_all(Map& map, const Parameters& parameters, int iterations) {
  if (map.keyframes.size() < 2) return;
  AdjustmentSelection selection = whole_selection(map, parameters);
  for (int round = 0; round < parameters.final_rounds; ++round) {
    Adjustment adjustment(map, parameters, selection, parameters.final_text_views);
    adjustment.weigh_texts(map);
    adjustment.solve(iterations);
    adjustment.write_back(map);
    adjustment.write_back_texts(map);
    if (adjustment.remove_outliers(map) == 0) break;
    erase_if(selection.points, [&](int id) { return map.point(id).bad; });
  }
}

}  // namespace textslam
