#include "textslam/calibrate/turn_readout.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>

#include "textplane/solver/jackknife.hpp"
#include "textslam/common/algorithms.hpp"

namespace textslam {
namespace {

constexpr std::size_t kLeastPairs = 30, kLeastCorners = 30;
constexpr double kLeastError = 2e-4;     // radians: residuals are not taken to be smaller
constexpr double kLeastSine = 0.05;      // of the angle between ray and way: near it the lines cross
constexpr double kDirectionSigma = 0.1;  // radians, of a step of the way's direction: few corners tell it
constexpr double kLeastReadout = 3e-3;   // s: about what errors of the stamps and of the lens come to
constexpr double kLeastSigmas = 4;
constexpr double kSettled = 2e-5;  // s
constexpr int kMostRounds = 40;
constexpr std::size_t kTenths = 10;

using Vector5 = Eigen::Matrix<double, 5, 1>;
using Matrix5 = Eigen::Matrix<double, 5, 5>;

// What is estimated of a pair, and what it says of the readout once its own turn and way are eliminated.
struct PairState {
  Vec3 turn = Vec3::Zero(), way = Vec3::UnitX();
  bool ok = false;
  double information = 0, gradient = 0;
};

bool is_usable(const FramePair& pair) {
  return pair.rays.size() >= kLeastCorners && pair.seconds > 0 &&
         std::all_of(pair.rays.begin(), pair.rays.end(),
                     [](const RayPair& rays) { return rays.ray_a.allFinite() && rays.ray_b.allFinite(); });
}

// Cauchy's weights twice over, so that what moves by itself counts for nothing.
double weight(double error, double scale) {
  const double u = error * error / (6 * scale * scale);
  return 1 / ((1 + u) * (1 + u) * scale * scale);
}

double scale_of(std::vector<double> errors) { return std::max(1.5 * median(std::move(errors)), kLeastError); }

// The turn of a pair as if all points were far away; then the way by what is left.
void begin(const FramePair& pair, PairState* state) {
  constexpr int kSteps = 8;
  for (int i = 0; i < kSteps; ++i) {
    const Eigen::Matrix3d R = textplane::so3_exp<double>(state->turn);
    std::vector<double> errors;
    for (const RayPair& rays : pair.rays) errors.push_back((R * rays.ray_a - rays.ray_b).norm());
    const double scale = scale_of(errors);
    Eigen::Matrix3d H = Eigen::Matrix3d::Zero();
    Vec3 b = Vec3::Zero();
    for (std::size_t k = 0; k < errors.size(); ++k) {
      const Vec3 q = R * pair.rays[k].ray_a;
      const Eigen::Matrix3d J = -textplane::hat(q);
      H += weight(errors[k], scale) * J.transpose() * J;
      b -= weight(errors[k], scale) * J.transpose() * (q - pair.rays[k].ray_b);
    }
    state->turn = textplane::so3_log<double>(textplane::so3_exp<double>(Vec3(H.ldlt().solve(b))) * R);
  }
  const Eigen::Matrix3d R = textplane::so3_exp<double>(state->turn);
  Eigen::Matrix3d M = Eigen::Matrix3d::Zero();
  for (const RayPair& rays : pair.rays) {
    const Vec3 normal = (R * rays.ray_a).cross(rays.ray_b);
    M += normal * normal.transpose() / (1e-2 * kLeastError + normal.squaredNorm());
  }
  state->way = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(M).eigenvectors().col(0);
}

// Steps of the pair's turn and way at this readout; omega: at its two frames.
void refine(const FramePair& pair, double readout, const std::array<Vec3, 2>& omega, PairState* state) {
  constexpr int kSteps = 4;
  for (int i = 0; i < kSteps; ++i) {
    const Vec3 u = state->way.unitOrthogonal(), v = state->way.cross(u);
    std::vector<double> errors;
    std::vector<Vector6> rows;
    for (const RayPair& rays : pair.rays) {
      const Vec3 by_rows = rays.row_b * omega[1] - rays.row_a * omega[0];
      const Vec3 q = textplane::so3_exp<double>(Vec3(state->turn + readout * by_rows)) * rays.ray_a;
      const Vec3 normal = q.cross(rays.ray_b);
      const double sine = std::max(state->way.cross(q).norm(), kLeastSine);
      const Vec3 by_turn = q.cross(rays.ray_b.cross(state->way)) / sine;
      errors.push_back(state->way.dot(normal) / sine);
      rows.emplace_back();
      rows.back() << by_turn, u.dot(normal) / sine, v.dot(normal) / sine, by_turn.dot(by_rows);
    }
    std::vector<double> sizes;
    for (const double e : errors) sizes.push_back(std::abs(e));
    const double scale = scale_of(std::move(sizes));
    Matrix6 H = Matrix6::Zero();
    Vector6 b = Vector6::Zero();
    for (std::size_t k = 0; k < errors.size(); ++k) {
      H += weight(errors[k], scale) * rows[k] * rows[k].transpose();
      b -= weight(errors[k], scale) * errors[k] * rows[k];
    }
    Matrix5 own = H.topLeftCorner<5, 5>();
    own.diagonal().tail<2>().array() += 1 / (kDirectionSigma * kDirectionSigma);
    const auto factors = own.ldlt();
    const Vector5 cross = H.block<5, 1>(0, 5), step = factors.solve(b.head<5>());
    state->information = H(5, 5) - cross.dot(factors.solve(cross));
    state->gradient = b[5] - cross.dot(step);
    state->ok = step.allFinite() && std::isfinite(state->gradient);
    if (!state->ok) return;
    state->turn += step.head<3>();
    state->way = (state->way + u * step[3] + v * step[4]).normalized();
  }
}

// What each tenth of the pairs says of the readout.
std::vector<textplane::GroupEquations<1>> tenths(const std::vector<PairState>& told) {
  std::vector<textplane::GroupEquations<1>> groups(kTenths);
  for (std::size_t i = 0; i < told.size(); ++i) {
    textplane::GroupEquations<1>& group = groups[i * kTenths / told.size()];
    group.H(0, 0) += told[i].information;
    group.b[0] += told[i].gradient;
  }
  return groups;
}

// Where they lead together. 0 where nothing tells.
double step_of(const std::vector<textplane::GroupEquations<1>>& groups) {
  double information = 0, gradient = 0;
  for (const textplane::GroupEquations<1>& group : groups) {
    information += group.H(0, 0);
    gradient += group.b[0];
  }
  return information > 0 ? gradient / information : 0;
}

// How far the camera turned, and what that did to its images.
void measure(const std::vector<FramePair>& pairs, const std::vector<PairState>& states, TurnReadout* out) {
  double turn = 0, speed = 0, count = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (!states[i].ok) continue;
    turn += states[i].turn.squaredNorm();
    speed += (states[i].turn / pairs[i].seconds).squaredNorm();
    ++count;
  }
  out->turn = std::sqrt(turn / count);
  out->shear = std::abs(out->readout) * std::sqrt(speed / count / 12);  // rows evenly from -1/2 to 1/2: 1 / 12
}

}  // namespace

TurnReadout readout_of_turns(const std::vector<FramePair>& pairs) {
  TurnReadout out;
  std::vector<PairState> states(pairs.size());
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (!is_usable(pairs[i])) continue;
    begin(pairs[i], &states[i]);
    states[i].ok = states[i].turn.allFinite();
  }
  std::vector<PairState> told;
  for (int round = 0; round < kMostRounds; ++round) {
    const std::vector<PairState> before = states;
    told.clear();
    const auto speed = [&](std::size_t i) { return Vec3(before[i].turn / pairs[i].seconds); };
    for (std::size_t i = 1; i + 1 < pairs.size(); ++i) {
      if (!before[i - 1].ok || !before[i].ok || !before[i + 1].ok) continue;
      refine(pairs[i], out.readout, {(speed(i - 1) + speed(i)) / 2, (speed(i) + speed(i + 1)) / 2}, &states[i]);
      if (states[i].ok) told.push_back(states[i]);
    }
    if (told.size() < kLeastPairs) return {};
    const auto groups = tenths(told);
    const double step = step_of(groups);
    out.sigma = std::sqrt(textplane::jackknife_covariance(groups)(0, 0));
    out.readout += step;
    if (std::abs(step) < kSettled) break;
  }
  measure(pairs, states, &out);
  out.determined = std::abs(out.readout) > std::max(kLeastReadout, kLeastSigmas * out.sigma);
  return out;
}

}  // namespace textslam
