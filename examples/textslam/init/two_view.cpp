#include "textslam/init/two_view.hpp"

#include <algorithm>
#include <cmath>

#include "textplane/core/numeric.hpp"
#include "textplane/core/se3.hpp"
#include "textplane/geometry/plane_fit.hpp"
#include "textslam/common/algorithms.hpp"

namespace textslam {
namespace {

constexpr double kUnknown = 1e9;       // radians: of a direction that the matches leave open
constexpr double kMinVariance = 0.01;  // px^2: of matches without noise

using Vec5 = Eigen::Matrix<double, 5, 1>;
using Mat5 = Eigen::Matrix<double, 5, 5>;

struct Hypothesis {
  Eigen::Matrix3d R;
  Vec3 t;
  double cost = 0;  // px^2
  Mat5 information = Mat5::Zero();
  int in_front = 0;
};

double huber_weight(double r, double bound) { return std::abs(r) <= bound ? 1 : bound / std::abs(r); }
double huber_cost(double r, double bound) { return std::abs(r) <= bound ? r * r : bound * (2 * std::abs(r) - bound); }

// The rotation that best turns a into b, translation ignored: where the search starts.
Eigen::Matrix3d rotation_only(const std::vector<Vec3>& a, const std::vector<Vec3>& b, double focal,
                              const Parameters& parameters) {
  const double scale = parameters.init_rotation_scale;
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  for (int iteration = 0; iteration < parameters.init_rotation_iterations; ++iteration) {
    Eigen::Matrix3d H = 1e-9 * Eigen::Matrix3d::Identity();
    Vec3 g = Vec3::Zero();
    for (std::size_t i = 0; i < a.size(); ++i) {
      const Vec3 p = (R * a[i]).normalized(), e = p - b[i].normalized();
      const double w = 1 / (1 + focal * focal * e.squaredNorm() / (scale * scale));
      const Eigen::Matrix3d J = -textplane::hat(p);
      H += w * J.transpose() * J;
      g += w * J.transpose() * e;
    }
    const textplane::Ldlt<double, 3> ldlt(H);
    if (!ldlt.ok()) break;
    const Vec3 step = -ldlt.solve(g);
    R = textplane::so3_exp(step) * R;
    if (step.norm() < 1e-8) break;
  }
  return R;
}

// Sampson distance in px of a match; its derivative with the denominator held, if asked.
double sampson(const Hypothesis& h, const Vec3& a, const Vec3& b, double focal,
               const Eigen::Matrix<double, 3, 2>* basis, Vec5* J) {
  const Vec3 q = h.R * a, line_b = h.t.cross(q), line_a = h.R.transpose() * b.cross(h.t);
  const double norm = std::sqrt(line_b.head<2>().squaredNorm() + line_a.head<2>().squaredNorm());
  if (!(norm > 1e-12)) {
    if (J) J->setZero();
    return 0;
  }
  const double scale = focal / norm;
  if (J) {
    J->head<3>() = scale * q.cross(b.cross(h.t));
    J->tail<2>() = scale * basis->transpose() * q.cross(b);
  }
  return scale * b.dot(line_b);
}

void tangent_basis(const Vec3& t, Eigen::Matrix<double, 3, 2>* basis) {
  const Vec3 helper = std::abs(t.x()) < 0.6 ? Vec3::UnitX() : Vec3::UnitY();
  basis->col(0) = t.cross(helper).normalized();
  basis->col(1) = t.cross(basis->col(0));
}

// Points in front of both cameras with visible depth, for +t.
int count_in_front(const Hypothesis& h, const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  int n = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    // Depths from z_b b = z_a R a + t by least squares.
    const Vec3 q = h.R * a[i];
    const double qq = q.dot(q), bb = b[i].dot(b[i]), qb = q.dot(b[i]), det = qq * bb - qb * qb;
    if (!(det > 1e-12)) continue;
    const double za = (qb * b[i].dot(h.t) - bb * q.dot(h.t)) / det, zb = (qq * b[i].dot(h.t) - qb * q.dot(h.t)) / det;
    if (za > 0 && zb > 0) ++n;
  }
  return n;
}

// The other motion that moves a plane's points the same way. H = R (I + a theta^T), a = R^T t, and H^T H = I + theta
// b^T + b theta^T with b = a + |a|^2 theta / 2: theta and b may change places.
bool planar_twin(const Hypothesis& h, const std::vector<Vec3>& a, const std::vector<Vec3>& b, Hypothesis* twin) {
  const auto plane = textplane::plane_from_matches(a, b, SE3d{h.R, h.t});
  // A wrong motion often has part of its plane behind the camera; the twin is in front all the same.
  if (!textplane::is_ok(plane.status) && plane.status != textplane::Status::behind_camera) return false;
  const Vec3 theta = plane.value, motion = h.R.transpose() * h.t;
  const Vec3 swapped = motion + 0.5 * motion.squaredNorm() * theta;
  const double s = motion.squaredNorm() * theta.squaredNorm() / swapped.squaredNorm();
  const Vec3 other = theta - 0.5 * s * swapped;
  const double det = 1 + other.dot(swapped);
  if (!(other.norm() > 1e-9) || !(std::abs(det) > 1e-9)) return false;
  const Eigen::Matrix3d H = h.R + h.t * theta.transpose();
  const SE3d T = textplane::renormalised(SE3d{H - H * other * swapped.transpose() / det, Vec3::Zero()});
  twin->R = T.R;
  twin->t = (T.R * other).normalized();
  return twin->R.allFinite() && twin->t.allFinite();
}

// The matches, and the search for motions that explain them.
class TwoViewSearch {
 public:
  TwoViewSearch(const std::vector<Vec3>& a, const std::vector<Vec3>& b, double focal, const Parameters& parameters)
      : a_(a), b_(b), focal_(focal), parameters_(parameters) {}

  // All distinct minima, the best first.
  std::vector<Hypothesis> minima() {
    Hypothesis start;
    start.R = rotation_only(a_, b_, focal_, parameters_);
    // A half-sphere of directions: t and -t have the same epipolar lines.
    for (int polar = 0; polar < 4; ++polar) {
      const int around = polar == 0 ? 1 : polar == 3 ? 3 : 6;
      for (int k = 0; k < around; ++k) {
        const double inclination = polar * 30 * M_PI / 180, azimuth = (k + 0.5 * (polar % 2)) * M_PI / 3;
        start.t = Vec3(std::sin(inclination) * std::cos(azimuth), std::sin(inclination) * std::sin(azimuth),
                       std::cos(inclination));
        search_from(start);
      }
    }
    // On a plane one of two solutions may lie too far from where the search starts; it is computed from the other.
    const std::size_t searched = found_.size();
    for (std::size_t i = 0; i < searched; ++i) {
      Hypothesis twin;
      if (planar_twin(found_[i], a_, b_, &twin)) search_from(twin);
    }
    std::sort(found_.begin(), found_.end(), [](const Hypothesis& x, const Hypothesis& y) { return x.cost < y.cost; });
    return std::move(found_);
  }

 private:
  void search_from(Hypothesis h) {
    minimise(h);
    Hypothesis flipped = h;
    flipped.t = -h.t;
    h.in_front = count_in_front(h, a_, b_);
    flipped.in_front = count_in_front(flipped, a_, b_);
    const Hypothesis& kept = flipped.in_front > h.in_front ? flipped : h;
    for (const Hypothesis& other : found_)
      if (kept.t.dot(other.t) > std::cos(parameters_.init_distinct_direction) &&
          textplane::so3_log<double>(kept.R * other.R.transpose()).norm() < parameters_.init_distinct_rotation)
        return;
    found_.push_back(kept);
  }

  double total_cost(const Hypothesis& h) const {
    double cost = 0;
    for (std::size_t i = 0; i < a_.size(); ++i)
      cost += huber_cost(sampson(h, a_[i], b_[i], focal_, nullptr, nullptr), parameters_.init_huber);
    return cost;
  }

  void minimise(Hypothesis& h) const {
    Eigen::Matrix<double, 3, 2> basis;
    double lambda = 1e-3;
    h.cost = total_cost(h);
    for (int iteration = 0; iteration < parameters_.init_iterations; ++iteration) {
      tangent_basis(h.t, &basis);
      Mat5 H = Mat5::Zero();
      Vec5 g = Vec5::Zero();
      for (std::size_t i = 0; i < a_.size(); ++i) {
        Vec5 J;
        const double r = sampson(h, a_[i], b_[i], focal_, &basis, &J), w = huber_weight(r, parameters_.init_huber);
        H += w * J * J.transpose();
        g += w * r * J;
      }
      h.information = H;
      Mat5 damped = H;
      damped.diagonal() += lambda * H.diagonal() + Vec5::Constant(1e-9);
      const textplane::Ldlt<double, 5> ldlt(damped);
      if (!ldlt.ok()) return;
      const Vec5 step = -ldlt.solve(g);
      Hypothesis trial = h;
      trial.R = textplane::so3_exp<double>(step.head<3>()) * h.R;
      trial.t = (h.t + basis * step.tail<2>()).normalized();
      trial.cost = total_cost(trial);
      if (trial.cost < h.cost) {
        const bool settled = h.cost - trial.cost < 1e-6 * h.cost;
        h = trial;
        lambda = std::max(1e-7, lambda / 5);
        if (settled) return;
      } else {
        lambda *= 10;
        if (lambda > 1e6) return;
      }
    }
  }

  const std::vector<Vec3>&a_, &b_;
  double focal_;
  const Parameters& parameters_;
  std::vector<Hypothesis> found_;
};

// Largest standard deviation of the direction of translation, radians, for this variance of a match, px^2.
double direction_sigma(const Hypothesis& h, double variance) {
  Mat5 information = h.information;
  information.diagonal() += Vec5::Constant(1e-12);
  const textplane::Ldlt<double, 5> ldlt(information);
  if (!ldlt.ok()) return kUnknown;
  const Mat5 covariance = variance * ldlt.inverse();
  return std::sqrt(std::max(covariance(3, 3), covariance(4, 4)));
}

}  // namespace

TwoView estimate_two_view(const std::vector<Vec3>& a, const std::vector<Vec3>& b, double focal,
                          const Parameters& parameters) {
  TwoView best;
  if (static_cast<int>(a.size()) < parameters.init_least_points || a.size() != b.size()) return best;
  std::vector<Hypothesis> found = TwoViewSearch(a, b, focal, parameters).minima();
  const int enough = static_cast<int>(parameters.init_in_front * static_cast<double>(a.size()));
  erase_if(found, [&](const Hypothesis& h) { return h.in_front < enough; });
  if (found.empty()) return best;

  for (const Hypothesis& h : found) best.motions.push_back({SE3d{h.R, h.t}, h.cost});
  best.T_b_a = best.motions.front().T_b_a;
  const Hypothesis& chosen = found.front();
  best.inlier.assign(a.size(), 0);
  std::vector<double> parallaxes;
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double r = sampson(chosen, a[i], b[i], focal, nullptr, nullptr);
    const Vec3 q = chosen.R * a[i];
    if (std::abs(r) > parameters.init_inlier) continue;
    best.inlier[i] = 1;
    sum += r * r;
    parallaxes.push_back(degrees_between(q, b[i]));
  }
  best.inliers = static_cast<int>(parallaxes.size());
  if (best.inliers < parameters.init_least_points) return best;
  best.rms = std::sqrt(sum / best.inliers);
  best.parallax = median(parallaxes);
  best.direction_sigma =
      direction_sigma(chosen, std::max(chosen.cost / (static_cast<double>(a.size()) - kTwoViewFreedom), kMinVariance));
  best.ok = true;
  return best;
}

}  // namespace textslam
