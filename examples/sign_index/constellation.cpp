#include "sign_index/constellation.hpp"

#include <algorithm>
#include <cmath>

#include "sign_index/planar_pose.hpp"
#include "sign_index/wall.hpp"

namespace textslam {
namespace {

constexpr double kSeedChi2 = 20;  // two degrees of freedom
constexpr double kSignChi2 = 30;  // eight
constexpr double kGate = 20;      // squared standard deviations of a centre, two degrees of freedom
constexpr double kLeastGain = 1;  // nats
constexpr double kLeastCosine = 0.4, kLeastHeight = 12;  // of a sign that should have been detected; px
constexpr double kMostUncertain = 15;                    // px: beyond it nobody can say that a sign should be there
constexpr double kMostAbsent = -6;                       // nats
constexpr double kLog2Pi = 1.8378770664093453;
constexpr double kSamePose = 1;             // degrees
constexpr double kShare = 0.25;             // of the reach: the side of the cube of places that show a sign
constexpr double kTurns = 8 * M_PI * M_PI;  // volume of all rotations

}  // namespace

// The signs around the seed that face the camera within a margin of half the image.
void Constellation::keep_in_view(const QueryView& view, std::uint32_t seed, const SE3d& T_c_w) {
  near_.clear();
  const Vec3 eye = T_c_w.inverse().t;
  const Vec2 margin = 0.5 * (view.high - view.low);
  const Vec2 low = view.low - margin, high = view.high + margin;
  for (const std::uint32_t cell : index_.around(index_.cell(seed)))
    for (std::uint32_t sign = index_.first_of(cell); sign < index_.first_of(cell + 1); ++sign) {
      const Vec3 centre = index_.centre(sign), p = T_c_w * centre;
      if (!(p.z() > 0) || p.squaredNorm() > index_.reach() * index_.reach() || sign == seed) continue;
      if (p.x() < low.x() * p.z() || p.x() > high.x() * p.z() || p.y() < low.y() * p.z() || p.y() > high.y() * p.z())
        continue;
      const Vec3 first = index_.corner(sign, 0);
      const Vec3 right = index_.corner(sign, 1) - first, down = index_.corner(sign, 3) - first;
      if (down.cross(right).dot(eye - centre) > 0) near_.push_back({sign, centre});
    }
}

std::optional<Constellation::Pair> Constellation::best_pair(const QueryView& view, const SignPose& pose,
                                                            const std::vector<Pair>& refused) const {
  std::optional<Pair> best;
  if (std::all_of(query_taken_.begin(), query_taken_.end(), [](std::uint8_t taken) { return taken != 0; })) return best;
  const Vec2 size = view.high - view.low;
  for (std::size_t n = 0; n < near_.size(); ++n) {
    CentreView there;
    if (!view_of_centre(pose, near_[n].centre, &there)) continue;
    const bool taken = std::any_of(sightings_.begin(), sightings_.end(),
                                   [&](const SignSighting& s) { return s.sign == near_[n].sign; });
    if (taken) continue;
    const Eigen::Matrix2d S = there.covariance + view.sigma * view.sigma * Eigen::Matrix2d::Identity();
    const Eigen::Matrix2d information = S.inverse();
    for (std::size_t q = 0; q < view.signs.size(); ++q) {
      if (query_taken_[q]) continue;
      const Vec2 e = view.signs[q].centre - there.at;
      const double distance = e.dot(information * e);
      if (!(distance < kGate)) continue;
      const double peak = std::log(size[0] * size[1]) - kLog2Pi - 0.5 * std::log(S.determinant());
      const double gain = peak - 0.5 * distance + view.signs[q].log_ratio(index_.word(near_[n].sign));
      if (gain < kLeastGain || (best && gain <= best->gain)) continue;
      const bool is_refused =
          std::any_of(refused.begin(), refused.end(), [&](const Pair& p) { return p.query == q && p.near == n; });
      if (!is_refused) best = Pair{q, n, gain};
    }
  }
  return best;
}

bool Constellation::extend(const QueryView& view, SignPose* pose) {
  std::vector<Pair> refused;
  while (const auto pair = best_pair(view, *pose, refused)) {
    const std::uint32_t sign = near_[pair->near].sign;
    SignPose trial = *pose;
    seen_.push_back({index_.corners(sign), view.signs[pair->query].quad});
    if (refine_sign_pose(seen_, view.sigma, options_.upright, &trial) && trial.chi2 - pose->chi2 < kSignChi2) {
      *pose = trial;
      sightings_.push_back({static_cast<int>(pair->query), sign});
      query_taken_[pair->query] = 1;
    } else {
      seen_.pop_back();
      refused.push_back(*pair);
      if (refused.size() > 8) break;
    }
  }
  return sightings_.size() > 1;
}

// Signs that stand in the image at this pose and that nobody detected.
double Constellation::absent(const QueryView& view, const SignPose& pose) const {
  double sum = 0;
  const double px = view.sigma / options_.corner_sigma;
  const Vec3 eye = pose.T_c_w.inverse().t;
  const auto is_inside = [&](const Vec2& at) {
    return (at.array() > view.low.array() + 5 * px).all() && (at.array() < view.high.array() - 5 * px).all();
  };
  for (const Near& near : near_) {
    CentreView there;
    const Vec3 centre = pose.T_c_w * near.centre;
    if (!(centre.z() > 0) || !is_inside(centre.hnormalized())) continue;
    if (std::any_of(sightings_.begin(), sightings_.end(), [&](const SignSighting& s) { return s.sign == near.sign; }))
      continue;
    if (!view_of_centre(pose, near.centre, &there)) continue;
    if (!(there.covariance.trace() < 2 * std::pow(kMostUncertain * px, 2))) continue;
    const auto corners = index_.corners(near.sign);
    std::array<Vec2, 4> at;
    bool inside = true;
    for (std::size_t k = 0; k < 4 && inside; ++k) {
      const Vec3 p = pose.T_c_w * corners[k];
      inside = p.z() > 0;
      if (!inside) break;
      at[k] = p.hnormalized();
      inside = is_inside(at[k]);
    }
    if (!inside) continue;
    const Vec3 normal = sign_normal(corners);
    const double height = std::min((at[3] - at[0]).norm(), (at[2] - at[1]).norm());
    if (normal.dot((eye - near.centre).normalized()) > kLeastCosine && height > kLeastHeight * px)
      sum += std::log(options_.missed);
  }
  return std::max(sum, kMostAbsent);
}

std::optional<FoundPlace> Constellation::place(const QueryView& view, const PlaceSeed& seed, const SE3d& T_c_w) {
  sightings_.assign(1, {static_cast<int>(seed.query), seed.sign});
  seen_.assign(1, {index_.corners(seed.sign), view.signs[seed.query].quad});
  query_taken_.assign(view.signs.size(), 0);
  query_taken_[seed.query] = 1;
  SignPose pose;
  pose.T_c_w = T_c_w;
  if (!refine_sign_pose(seen_, view.sigma, options_.upright, &pose) || !(pose.chi2 < kSeedChi2)) return std::nullopt;
  keep_in_view(view, seed.sign, pose.T_c_w);
  if (extend(view, &pose)) keep_in_view(view, seed.sign, pose.T_c_w);

  FoundPlace found;
  found.T_c_w = pose.T_c_w;
  found.covariance = pose.covariance;
  const double share = kShare * index_.reach();
  const auto& upright = options_.upright;
  const double turns = upright ? std::pow(2 * M_PI, 2) * upright->roll * upright->pitch : kTurns;
  found.log_evidence = -0.5 * pose.chi2 + 3 * kLog2Pi + pose.log_volume - std::log(index_.size()) -
                       std::log(turns * share * share * share) + absent(view, pose);
  const WallView wall{pose.T_c_w, view.sigma, options_.missed, index_.reach()};
  for (std::size_t i = 0; i < sightings_.size(); ++i) {
    const QuerySign& sign = view.signs[static_cast<std::size_t>(sightings_[i].detection)];
    const SignCorners& corners = seen_[i].corners;
    const bool beside = std::any_of(seen_.begin(), seen_.begin() + static_cast<std::ptrdiff_t>(i),
                                    [&](const SeenSign& other) { return on_one_wall(other.corners, corners); });
    // Elsewhere it may be either: a quad anywhere, or one on the wall.
    const double peak =
        beside ? -std::log(std::exp(-sign.log_peak) + std::exp(-log_wall_peak(corners, wall))) : sign.log_peak;
    found.log_evidence += sign.log_ratio(index_.word(sightings_[i].sign)) + peak;
    found.sightings.push_back({sign.detection, sightings_[i].sign});
  }
  return found;
}

std::optional<FoundPlace> Constellation::grow(const QueryView& view, const PlaceSeed& seed) {
  const PlanarPose poses = planar_pose(index_.corners(seed.sign), view.signs[seed.query].quad);
  std::optional<FoundPlace> best;
  for (int i = 0; i < poses.count; ++i) {
    // Closed form poses are near the least squares.
    const double chi = poses.error[static_cast<std::size_t>(i)] / view.sigma;
    if (4 * chi * chi > 4 * kSeedChi2) continue;
    auto found = place(view, seed, poses.T_c_q[static_cast<std::size_t>(i)]);
    if (!found) continue;
    if (!best) {
      best = std::move(found);
    } else if (degrees(found->T_c_w.R * best->T_c_w.R.transpose()) > kSamePose) {
      const double other = std::min(found->log_evidence, best->log_evidence);
      if (found->log_evidence > best->log_evidence) best = std::move(found);
      best->pose_share = 1 / (1 + std::exp(other - best->log_evidence));
    }
  }
  return best;
}

}  // namespace textslam
