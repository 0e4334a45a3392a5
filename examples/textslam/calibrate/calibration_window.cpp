#include "textslam/calibrate/calibration_window.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "textslam/adjust/adjustment_selection.hpp"
#include "textslam/common/algorithms.hpp"

namespace textslam {
namespace {

using textplane::Window;
using textplane::WindowCalibration;
using textplane::WindowPointObservation;

constexpr int kIterations = 30;
constexpr int kLeastObservations = 3;  // of a point
constexpr int kParts = 6;              // of key frames in turn, for jackknife and cross-validation
constexpr double kOutlier = 3;         // times the error of the middle observation

// The Huber cost that a camera leaves; infinite where the window has no solution with it.
double cost_with(const textplane::AnyCamera<double>& camera, Window window, const textplane::WindowOptions& options) {
  WindowCalibration held;
  held.camera = camera;
  held.mean = camera.parameters();
  held.hold();
  window.calibration = &held;
  textplane::WindowWorkspace workspace;
  const textplane::WindowSummary summary = textplane::solve_window(window, options, workspace);
  return textplane::is_ok(summary.status) ? summary.final_cost : std::numeric_limits<double>::infinity();
}

}  // namespace

CalibrationWindow::CalibrationWindow(const Map& map, const Parameters& parameters, const CalibrationExtent& extent) {
  AdjustmentSelection selection = whole_selection(map, parameters);
  std::vector<int>& free = selection.free_frames;
  if (extent.keyframes > 0 && free.size() >= extent.keyframes) free.resize(extent.keyframes - 1);
  std::vector<int> slot(map.keyframes.size(), -1);
  const auto add_frame = [&](int id, bool fixed) {
    slot[static_cast<std::size_t>(id)] = static_cast<int>(window_.frames.size());
    rows_.push_back(map.keyframe(id).frame.rows);
    window_.frames.push_back({map.keyframe(id).T_w_c, fixed, {}, rows_.back().get()});
  };
  for (const int id : selection.fixed_frames) add_frame(id, true);
  for (const int id : free) add_frame(id, false);
  options_.scale_frame_a = slot[static_cast<std::size_t>(selection.fixed_frames.front())];
  options_.scale_frame_b = slot[static_cast<std::size_t>(selection.scale_frame)];
  if (options_.scale_frame_b < 0) options_.scale_frame_b = static_cast<int>(window_.frames.size()) - 1;
  options_.max_iterations = kIterations;
  add_points(map, selection.points, slot, parameters.window_point_sigma, extent.observations);
}

void CalibrationWindow::add_points(const Map& map, const std::vector<int>& ids, const std::vector<int>& slot,
                                   double sigma, std::size_t most_observations) {
  const auto slot_of = [&slot](const PointObservation& o) { return slot[static_cast<std::size_t>(o.keyframe)]; };
  std::vector<int> points;
  std::size_t observations = 0;
  for (const int id : ids) {
    const auto& list = map.point(id).observations;
    const auto count = std::count_if(list.begin(), list.end(), [&](const auto& o) { return slot_of(o) >= 0; });
    if (count < kLeastObservations) continue;
    points.push_back(id);
    observations += static_cast<std::size_t>(count);
  }
  const std::size_t most = most_observations * window_.frames.size();
  const std::size_t step = most > 0 ? 1 + observations / most : 1;
  for (std::size_t i = 0; i < points.size(); i += step) {
    const MapPoint& point = map.point(points[i]);
    for (const PointObservation& o : point.observations)
      if (slot_of(o) >= 0)
        window_.point_observations.push_back({slot_of(o), static_cast<int>(window_.points.size()), o.px, sigma});
    window_.points.push_back({point.p_w});
  }
}

bool CalibrationWindow::solve(WindowCalibration* calibration) {
  Window trial = window_;
  trial.calibration = calibration;
  textplane::WindowWorkspace workspace;
  const textplane::Status status = textplane::solve_window(trial, options_, workspace).status;
  if (!textplane::is_ok(status) || !textplane::is_ok(calibration->status)) return false;
  trial.calibration = nullptr;
  window_ = std::move(trial);
  return true;
}

double CalibrationWindow::variance() const {
  double sum = 0, count = 0;
  for (const WindowPointObservation& o : window_.point_observations)
    if (textplane::is_ok(o.status) && o.chi2 < options_.point_robust.delta * options_.point_robust.delta) {
      sum += o.chi2;
      count += 2;
    }
  const double unknowns =
      3.0 * static_cast<double>(window_.points.size()) + 6.0 * static_cast<double>(window_.frames.size());
  return count > unknowns ? sum / (count - unknowns) : std::numeric_limits<double>::infinity();
}

std::vector<double> CalibrationWindow::variances(const WindowCalibration& solved) const {
  std::vector<double> out;
  const double unit = variance();
  for (Eigen::Index i = 0; i < solved.covariance.rows(); ++i)
    out.push_back(unit * std::max(solved.covariance(i, i), 0.0));
  return out;
}

int CalibrationWindow::part_of(int frame) const { return frame * kParts / static_cast<int>(window_.frames.size()); }

std::vector<LeftOut> CalibrationWindow::leave_out(const WindowCalibration& solved) const {
  std::vector<LeftOut> out;
  textplane::WindowWorkspace workspace;
  for (int part = 0; part < kParts; ++part) {
    Window others = window_;
    erase_if(others.point_observations, [&](const WindowPointObservation& o) {
      const bool sets_scale = o.frame == options_.scale_frame_a || o.frame == options_.scale_frame_b;
      return !sets_scale && part_of(o.frame) == part;
    });
    WindowCalibration trial = solved;
    others.calibration = &trial;
    if (textplane::is_ok(textplane::solve_window(others, options_, workspace).status))
      out.push_back({part, trial.camera});
  }
  return out;
}

std::vector<double> CalibrationWindow::jackknife(const WindowCalibration& solved, const std::vector<LeftOut>& parts) {
  const auto of_all = solved.camera.parameters();
  const auto count = static_cast<std::size_t>(of_all.size());
  const auto used = static_cast<double>(parts.size());
  if (parts.size() < 2) return std::vector<double>(count, std::numeric_limits<double>::infinity());
  std::vector<double> sums(count, 0), squares(count, 0);
  for (const LeftOut& left : parts) {
    const auto p = left.camera.parameters();
    for (std::size_t i = 0; i < count; ++i) {
      const double off = p[static_cast<Eigen::Index>(i)] - of_all[static_cast<Eigen::Index>(i)];
      sums[i] += off;
      squares[i] += off * off;
    }
  }
  for (std::size_t i = 0; i < count; ++i) squares[i] = (squares[i] - sums[i] * sums[i] / used) * (used - 1) / used;
  return squares;
}

Window CalibrationWindow::only(int part) const {
  Window out;
  std::vector<int> frames(window_.frames.size(), -1), points(window_.points.size(), -1), seen(window_.points.size(), 0);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (part_of(static_cast<int>(i)) != part) continue;
    frames[i] = static_cast<int>(out.frames.size());
    out.frames.push_back(window_.frames[i]);
    out.frames.back().fixed = out.frames.size() == 1;
  }
  for (const WindowPointObservation& o : window_.point_observations)
    if (part_of(o.frame) == part) ++seen[static_cast<std::size_t>(o.point)];
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (seen[i] < kLeastObservations) continue;
    points[i] = static_cast<int>(out.points.size());
    out.points.push_back(window_.points[i]);
  }
  for (WindowPointObservation o : window_.point_observations) {
    o.frame = frames[static_cast<std::size_t>(o.frame)];
    o.point = points[static_cast<std::size_t>(o.point)];
    if (o.frame >= 0 && o.point >= 0) out.point_observations.push_back(o);
  }
  return out;
}

double CalibrationWindow::gain(const std::vector<LeftOut>& parts, const textplane::AnyCamera<double>& held) const {
  std::vector<double> gains;
  for (const LeftOut& left : parts) {
    const Window own = only(left.part);
    if (own.frames.size() < 2 || own.points.empty()) continue;
    textplane::WindowOptions options = options_;
    options.scale_frame_a = 0;
    options.scale_frame_b = static_cast<int>(own.frames.size()) - 1;
    const double with_held = cost_with(held, own, options), with_told = cost_with(left.camera, own, options);
    if (std::isfinite(with_held) && std::isfinite(with_told) && with_held > 0)
      gains.push_back(1 - with_told / with_held);
  }
  return gains.empty() ? 0 : median(std::move(gains));
}

void CalibrationWindow::remove_outliers() {
  std::vector<double> all;
  for (const WindowPointObservation& o : window_.point_observations) all.push_back(o.chi2);
  const double most = kOutlier * kOutlier * median(std::move(all));
  erase_if(window_.point_observations, [&](const WindowPointObservation& o) { return !(o.chi2 <= most); });
}

std::pair<std::size_t, double> CalibrationWindow::fit() const {
  double sum = 0;
  std::size_t count = 0;
  for (const WindowPointObservation& o : window_.point_observations) {
    if (!textplane::is_ok(o.status)) continue;
    sum += o.chi2 * o.sigma * o.sigma;
    ++count;
  }
  return {count, count > 0 ? std::sqrt(sum / static_cast<double>(count)) : 0};
}

}  // namespace textslam
