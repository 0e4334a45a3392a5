#include "textslam/calibrate/map_calibration.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "textplane/solver/window.hpp"
#include "textslam/adjust/adjustment_selection.hpp"
#include "textslam/common/algorithms.hpp"

namespace textslam {
namespace {

using textplane::Window;
using textplane::WindowCalibration;

constexpr int kIterations = 30;
constexpr int kLeastObservations = 3;  // of a point
constexpr int kGroups = 6;             // of key frames in turn, for the jackknife
constexpr int kRounds = 3;             // of removing outliers in the end
constexpr double kOutlier = 3;         // times the error of the middle observation

// Key frames and points of a map as a window, frames in the order of time: the first key frame is the fixed one.
class CalibrationWindow {
 public:
  CalibrationWindow(const Map& map, const Parameters& parameters) {
    const AdjustmentSelection selection = whole_selection(map, parameters);
    std::vector<int> slot(map.keyframes.size(), -1);
    const auto add_frame = [&](int id, bool fixed) {
      slot[static_cast<std::size_t>(id)] = static_cast<int>(window_.frames.size());
      rows_.push_back(map.keyframe(id).frame.rows);
      window_.frames.push_back({map.keyframe(id).T_w_c, fixed, {}, rows_.back().get()});
    };
    for (const int id : selection.fixed_frames) add_frame(id, true);
    for (const int id : selection.free_frames) add_frame(id, false);
    options_.scale_frame_a = slot[static_cast<std::size_t>(selection.fixed_frames.front())];
    options_.scale_frame_b = slot[static_cast<std::size_t>(selection.scale_frame)];
    options_.max_iterations = kIterations;
    for (const int id : selection.points) {
      const MapPoint& point = map.point(id);
      if (point.observations.size() < kLeastObservations) continue;
      for (const PointObservation& o : point.observations)
        if (slot[static_cast<std::size_t>(o.keyframe)] >= 0)
          window_.point_observations.push_back({slot[static_cast<std::size_t>(o.keyframe)],
                                                static_cast<int>(window_.points.size()), o.px,
                                                parameters.window_point_sigma});
      window_.points.push_back({point.p_w});
    }
  }

  // Solves for the parameters whose sigma is not zero. The window keeps the result where it is one.
  bool solve(WindowCalibration* calibration) {
    Window trial = window_;
    trial.calibration = calibration;
    const textplane::Status status = textplane::solve_window(trial, options_, workspace_).status;
    if (!textplane::is_ok(status) || !textplane::is_ok(calibration->status)) return false;
    trial.calibration = nullptr;
    window_ = std::move(trial);
    return true;
  }

  // Variance of an observation's error, in units of its sigma, from the residuals and what they had to fit.
  double variance() const {
    double sum = 0, count = 0;
    for (const auto& o : window_.point_observations)
      if (textplane::is_ok(o.status) && o.chi2 < options_.point_robust.delta * options_.point_robust.delta) {
        sum += o.chi2;
        count += 2;
      }
    const double unknowns =
        3.0 * static_cast<double>(window_.points.size()) + 6.0 * static_cast<double>(window_.frames.size());
    return count > unknowns ? sum / (count - unknowns) : std::numeric_limits<double>::infinity();
  }
  // Variances of the parameters by the covariance, which takes all errors as independent,
  std::vector<double> variances(const WindowCalibration& c) const {
    std::vector<double> out;
    for (Eigen::Index i = 0; i < c.covariance.rows(); ++i)
      out.push_back(variance() * std::max(c.covariance(i, i), 0.0));
    return out;
  }
  // and by a jackknife over parts of the sequence: shutter and blur move all points of a frame alike.
  std::vector<double> jackknife(const WindowCalibration& best) {
    const auto of_best = best.camera.parameters();
    const auto count = static_cast<std::size_t>(of_best.size());
    std::vector<double> sums(count, 0), squares(count, 0);
    int used = 0;
    for (int group = 0; group < kGroups; ++group) {
      Window part = window_;
      const auto left_out = [&](const textplane::WindowPointObservation& o) {
        if (o.frame == options_.scale_frame_a || o.frame == options_.scale_frame_b) return false;
        return o.frame * kGroups / static_cast<int>(window_.frames.size()) == group;
      };
      auto& list = part.point_observations;
      list.erase(std::remove_if(list.begin(), list.end(), left_out), list.end());
      WindowCalibration trial = best;
      part.calibration = &trial;
      if (!textplane::is_ok(textplane::solve_window(part, options_, workspace_).status)) continue;
      ++used;
      const auto p = trial.camera.parameters();
      for (std::size_t i = 0; i < count; ++i) {
        const double off = p[static_cast<Eigen::Index>(i)] - of_best[static_cast<Eigen::Index>(i)];
        sums[i] += off;
        squares[i] += off * off;
      }
    }
    for (std::size_t i = 0; i < count; ++i)
      squares[i] = used > 1 ? (squares[i] - sums[i] * sums[i] / used) * (used - 1) / used
                            : std::numeric_limits<double>::infinity();
    return squares;
  }
  void remove_outliers() {
    std::vector<double> all;
    for (const auto& o : window_.point_observations) all.push_back(o.chi2);
    const double most = kOutlier * kOutlier * median(std::move(all));
    auto& list = window_.point_observations;
    list.erase(std::remove_if(list.begin(), list.end(), [&](const auto& o) { return !(o.chi2 <= most); }), list.end());
  }
  void describe(MapCalibration* out) const {
    double sum = 0;
    for (const auto& o : window_.point_observations) {
      if (!textplane::is_ok(o.status)) continue;
      sum += o.chi2 * o.sigma * o.sigma;
      ++out->observations;
    }
    if (out->observations > 0) out->reprojection_px = std::sqrt(sum / static_cast<double>(out->observations));
  }

 private:
  Window window_;
  std::vector<std::shared_ptr<const textplane::RowMotion>> rows_;  // of its frames
  textplane::WindowOptions options_;
  textplane::WindowWorkspace workspace_;
};

// The parameters in the order in which they are tried: those of a step together.
std::vector<std::vector<int>> steps(const CameraModel& camera) {
  std::vector<std::vector<int>> out = {{0}};
  // Of all models the first two coefficients are the radial ones.
  const auto count = static_cast<int>(camera.raw.parameters().size());
  for (int i = 4; i < std::min(count, 6); ++i) out.push_back({i});
  out.push_back({2, 3});
  return out;
}

double prior_of(int parameter, const CameraModel& guess, const CalibrationPriors& priors) {
  if (parameter < 2) return priors.focal * guess.pinhole().fx;
  return parameter < 4 ? priors.principal * guess.width : priors.lens;
}

// Whether each parameter of a step is.
bool is_determined(const CameraModel& guess, const std::vector<int>& step, const std::vector<double>& variance,
                   const CalibrationPriors& priors) {
  return std::all_of(step.begin(), step.end(), [&](int i) {
    return std::sqrt(variance[static_cast<std::size_t>(i)]) < priors.determined * prior_of(i, guess, priors);
  });
}

// The larger of both variances.
std::vector<double> worst_variances(CalibrationWindow& window, const WindowCalibration& c) {
  std::vector<double> out = window.jackknife(c);
  const std::vector<double> plain = window.variances(c);
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = plain[i] > 0 ? std::max(out[i], plain[i]) : 0;
  return out;
}

// Whether one of them is not where the guess has it by chance.
bool is_significant(const WindowCalibration& c, const std::vector<int>& step, const std::vector<double>& variance,
                    const CalibrationPriors& priors) {
  const auto parameters = c.camera.parameters();
  return std::any_of(step.begin(), step.end(), [&](int i) {
    const double off = parameters[i] - c.mean[i];
    return off * off > priors.significant * variance[static_cast<std::size_t>(i)];
  });
}

}  // namespace

double camera_distance(const CameraModel& a, const CameraModel& b) {
  std::vector<Vec3> rays_a, rays_b;
  std::vector<Vec2> px;
  constexpr int kGrid = 12;
  for (int i = 0; i <= kGrid; ++i)
    for (int j = 0; j <= kGrid; ++j) {
      const Vec2 p((a.width - 1.0) * i / kGrid, (a.height - 1.0) * j / kGrid);
      Vec3 ray_a, ray_b;
      if (!textplane::is_ok(a.raw.unproject_ray(p, &ray_a)) || !textplane::is_ok(b.raw.unproject_ray(p, &ray_b)))
        return std::numeric_limits<double>::infinity();
      px.push_back(p);
      rays_a.push_back(ray_a);
      rays_b.push_back(ray_b);
    }
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < px.size(); ++i) covariance += rays_a[i] * rays_b[i].transpose();
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Matrix3d R = svd.matrixU() * svd.matrixV().transpose();
  double largest = 0;
  for (std::size_t i = 0; i < px.size(); ++i) {
    const Vec3 turned = R * rays_b[i];
    if (!a.raw.in_domain(turned)) return std::numeric_limits<double>::infinity();
    largest = std::max(largest, (a.raw.project(turned) - px[i]).norm());
  }
  return largest;
}

CameraModel with_lens(const CameraModel& camera) {
  CameraModel out = camera;
  if (const auto* pinhole = camera.raw.get_if<textplane::Pinhole<double>>())
    out.raw = textplane::RadialTangential<double>{*pinhole, 0, 0, 0, 0, 0};
  return out;
}

MapCalibration calibrate(const Map& map, const CameraModel& camera, const CameraModel& guess,
                         const Parameters& parameters, const CalibrationPriors& priors) {
  MapCalibration out;
  out.camera = camera;
  out.camera.shutter.readout = map.shutter.readout;
  out.sigma.assign(static_cast<std::size_t>(camera.raw.parameters().size()), 0);
  if (map.keyframe_ids().size() < 3) return out;
  CalibrationWindow window(map, parameters);
  WindowCalibration best;
  best.camera = camera.raw;
  best.mean = guess.raw.parameters();
  best.hold();
  if (!window.solve(&best)) return out;
  std::vector<std::vector<int>> free;
  for (const std::vector<int>& step : steps(camera)) {
    CalibrationWindow trial_window = window;
    WindowCalibration trial = best;
    // The window counts in deviations of its observations, which are not their errors.
    const double unit = std::sqrt(window.variance());
    for (const int i : step) trial.sigma[i] = prior_of(i, guess, priors) / unit;
    if (!trial_window.solve(&trial) || !is_determined(guess, step, trial_window.variances(trial), priors)) continue;
    window = std::move(trial_window);
    best = trial;
    free.push_back(step);
  }
  if (free.empty() || free.front().front() != 0) return out;
  for (int round = 0; round < kRounds; ++round) {
    window.remove_outliers();
    if (!window.solve(&best)) return out;
  }
  std::vector<double> variance = worst_variances(window, best);
  while (free.size() > 1 && !(is_determined(guess, free.back(), variance, priors) &&
                              is_significant(best, free.back(), variance, priors))) {
    auto values = best.camera.parameters();
    for (const int i : free.back()) {
      best.sigma[i] = 0;
      values[i] = best.mean[i];
    }
    free.pop_back();
    if (!textplane::is_ok(textplane::AnyCamera<double>::make(best.camera.name(), values, &best.camera)) ||
        !window.solve(&best))
      return out;
    variance = worst_variances(window, best);
  }
  if (!is_determined(guess, free.front(), variance, priors)) return out;
  window.describe(&out);
  out.determined = true;
  out.camera.raw = best.camera;
  for (std::size_t i = 0; i < out.sigma.size(); ++i) out.sigma[i] = std::sqrt(variance[i]);
  return out;
}

}  // namespace textslam
