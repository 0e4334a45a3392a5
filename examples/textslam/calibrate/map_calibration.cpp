#include "textslam/calibrate/map_calibration.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace textslam {
namespace {

using textplane::WindowCalibration;

constexpr int kRounds = 3;  // of removing outliers in the end
const std::vector<int> kFocal = {0};

// The parameters in the order in which they are tried: those of a step together.
std::vector<std::vector<int>> steps(const CameraModel& camera, const CalibrationPriors& priors) {
  std::vector<std::vector<int>> out;
  if (priors.focal > 0) out.push_back(kFocal);
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

// What a solution is worth.
struct Certainty {
  std::vector<LeftOut> parts;
  std::vector<double> variance;  // the larger of both
};

Certainty certainty_of(const CalibrationWindow& window, const WindowCalibration& c) {
  Certainty out;
  out.parts = window.leave_out(c);
  out.variance = CalibrationWindow::jackknife(c, out.parts);
  const std::vector<double> plain = window.variances(c);
  for (std::size_t i = 0; i < plain.size(); ++i)
    out.variance[i] = plain[i] > 0 ? std::max(out.variance[i], plain[i]) : 0;
  return out;
}

// Gives the parameters of a step the guess again. Whether that is a camera.
bool hold(const std::vector<int>& step, WindowCalibration* c) {
  auto values = c->camera.parameters();
  for (const int i : step) {
    values[i] = c->mean[i];
    c->sigma[i] = 0;
  }
  return textplane::is_ok(textplane::AnyCamera<double>::make(c->camera.name(), values, &c->camera));
}

// Whether one of a step is not where the guess has it by chance.
bool is_significant(const WindowCalibration& c, const std::vector<int>& step, const std::vector<double>& variance,
                    const CalibrationPriors& priors) {
  const auto parameters = c.camera.parameters();
  return std::any_of(step.begin(), step.end(), [&](int i) {
    const double off = parameters[i] - c.mean[i];
    return off * off > priors.significant * variance[static_cast<std::size_t>(i)];
  });
}

// Solves step by step. Those that the covariance determines stay free.
std::vector<std::vector<int>> free_steps(const CameraModel& guess, const CalibrationPriors& priors,
                                         CalibrationWindow* window, WindowCalibration* best) {
  std::vector<std::vector<int>> out;
  for (const std::vector<int>& step : steps(guess, priors)) {
    CalibrationWindow trial_window = *window;
    WindowCalibration trial = *best;
    // The window counts in deviations of its observations, which are not their errors.
    const double unit = std::sqrt(window->variance());
    for (const int i : step) trial.sigma[i] = prior_of(i, guess, priors) / unit;
    if (!trial_window.solve(&trial) || !is_determined(guess, step, trial_window.variances(trial), priors)) continue;
    *window = std::move(trial_window);
    *best = trial;
    out.push_back(step);
  }
  return out;
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
  CalibrationWindow window(map, parameters, priors.extent);
  WindowCalibration best;
  best.camera = camera.raw;
  best.mean = guess.raw.parameters();
  best.hold();
  if (!window.solve(&best)) return out;
  const bool knows_focal = priors.focal == 0;
  const std::size_t least = knows_focal ? 0 : 1;  // steps, the focal length
  std::vector<std::vector<int>> free = free_steps(guess, priors, &window, &best);
  if (free.empty() || (!knows_focal && free.front() != kFocal)) return out;
  for (int round = 0; round < kRounds; ++round) {
    window.remove_outliers();
    if (!window.solve(&best)) return out;
  }
  Certainty certainty = certainty_of(window, best);
  while (free.size() > least && !(is_determined(guess, free.back(), certainty.variance, priors) &&
                                  is_significant(best, free.back(), certainty.variance, priors))) {
    if (!hold(free.back(), &best) || !window.solve(&best)) return out;
    free.pop_back();
    certainty = certainty_of(window, best);
  }
  if (free.empty() || !is_determined(guess, free.front(), certainty.variance, priors)) return out;
  if (priors.least_gain > 0 && window.gain(certainty.parts, camera.raw) < priors.least_gain) return out;
  std::tie(out.observations, out.reprojection_px) = window.fit();
  out.determined = true;
  out.camera.raw = best.camera;
  for (std::size_t i = 0; i < out.sigma.size(); ++i) out.sigma[i] = std::sqrt(certainty.variance[i]);
  return out;
}

}  // namespace textslam
