#include "io/evaluate.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace textslam {

namespace {

using Vector = Vector3<double>;

constexpr double kDegrees = 57.295779513082320877;

// Horn 1987: the rotation that maximises sum to_i . R from_i is the eigenvector of the largest eigenvalue of this
// matrix.
Matrix3<double> horn_rotation(const Matrix3<double>& m /* sum from_i to_i^T */) {
  Eigen::Matrix4d n;
  n << m(0, 0) + m(1, 1) + m(2, 2), m(1, 2) - m(2, 1), m(2, 0) - m(0, 2), m(0, 1) - m(1, 0),  //
      m(1, 2) - m(2, 1), m(0, 0) - m(1, 1) - m(2, 2), m(0, 1) + m(1, 0), m(2, 0) + m(0, 2),   //
      m(2, 0) - m(0, 2), m(0, 1) + m(1, 0), m(1, 1) - m(0, 0) - m(2, 2), m(1, 2) + m(2, 1),   //
      m(0, 1) - m(1, 0), m(2, 0) + m(0, 2), m(1, 2) + m(2, 1), m(2, 2) - m(0, 0) - m(1, 1);
  const Eigen::Vector4d q = textplane::symmetric_eigen<double, 4>(n).vectors.col(3);
  return Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized().toRotationMatrix();
}

// Centres, spread and correlation of two sets of positions.
struct Moments {
  std::size_t n = 0;
  Vector from_mean = Vector::Zero(), to_mean = Vector::Zero();
  Matrix3<double> correlation = Matrix3<double>::Zero();
  double from_spread = 0, to_spread = 0;

  // Of either set. Identical points have a spread above zero by rounding alone.
  bool is_single_place() const {
    const auto is_place = [this](double spread, const Vector& mean) {
      return !(spread > 1e-24 * static_cast<double>(n) * mean.squaredNorm()) || !(spread > 0);
    };
    return is_place(from_spread, from_mean) || is_place(to_spread, to_mean);
  }
};

// False where a position is not finite.
template <class From, class To>
bool find_moments(std::size_t n, const From& from, const To& to, Moments* m) {
  m->n = n;
  for (std::size_t i = 0; i < n; ++i) {
    if (!textplane::all_finite(from(i)) || !textplane::all_finite(to(i))) return false;
    m->from_mean += from(i);
    m->to_mean += to(i);
  }
  m->from_mean /= static_cast<double>(n);
  m->to_mean /= static_cast<double>(n);
  for (std::size_t i = 0; i < n; ++i) {
    const Vector a = from(i) - m->from_mean, b = to(i) - m->to_mean;
    m->correlation += a * b.transpose();
    m->from_spread += a.squaredNorm();
    m->to_spread += b.squaredNorm();
  }
  return true;
}

// The similarity of this rotation and scale, with its best translation.
Status finish(const Moments& m, Similarity result, Similarity* out) {
  if (!(result.scale > 0) || !textplane::is_finite(result.scale)) return Status::degenerate;
  result.t = m.to_mean - result.scale * (result.R * m.from_mean);
  *out = result;
  return Status::ok;
}

// The quantile of sorted errors: they lie at 0, 1/(n - 1), ..., 1, and it is linear between them.
double quantile(const std::vector<double>& sorted, double share) {
  if (sorted.empty()) return 0;
  const double at = share * static_cast<double>(sorted.size() - 1);
  const std::size_t below = static_cast<std::size_t>(at), above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (at - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

double median_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return quantile(values, 0.5);
}

class RelativeErrors {
 public:
  RelativeErrors(const std::vector<SE3d>& estimate, const std::vector<SE3d>& truth)
      : estimate_(estimate), truth_(truth) {}

  void add(std::size_t i, std::size_t j) {
    const SE3d true_motion = truth_[i].inverse() * truth_[j];
    const SE3d error = true_motion.inverse() * (estimate_[i].inverse() * estimate_[j]);
    translation_.push_back(error.t.norm());
    rotation_.push_back(kDegrees * textplane::so3_log(error.R).norm());
  }
  RelativeError result() { return {error_statistics(std::move(translation_)), error_statistics(std::move(rotation_))}; }

 private:
  const std::vector<SE3d>& estimate_;
  const std::vector<SE3d>& truth_;
  std::vector<double> translation_, rotation_;
};

}  // namespace

std::vector<PosePair> associate(const std::vector<StampedPose>& estimate, const std::vector<StampedPose>& truth,
                                double tolerance) {
  struct Candidate {
    double gap;
    PosePair pair;
  };
  std::vector<Candidate> candidates;
  std::size_t first = 0;
  for (std::size_t i = 0; i < estimate.size(); ++i) {
    const double time = estimate[i].timestamp;
    while (first < truth.size() && truth[first].timestamp < time - tolerance) ++first;
    for (std::size_t j = first; j < truth.size() && truth[j].timestamp <= time + tolerance; ++j) {
      candidates.push_back({std::abs(truth[j].timestamp - time), {i, j}});
    }
  }
  std::stable_sort(candidates.begin(), candidates.end(), [](const auto& a, const auto& b) { return a.gap < b.gap; });
  std::vector<bool> estimate_taken(estimate.size()), truth_taken(truth.size());
  std::vector<PosePair> pairs;
  for (const Candidate& candidate : candidates) {
    const PosePair& pair = candidate.pair;
    if (estimate_taken[pair.estimate] || truth_taken[pair.truth]) continue;
    estimate_taken[pair.estimate] = truth_taken[pair.truth] = true;
    pairs.push_back(pair);
  }
  std::sort(pairs.begin(), pairs.end(), [](const auto& a, const auto& b) { return a.estimate < b.estimate; });
  // With a tolerance above the spacing of the poses, poses left over could pair across closer pairs: time must increase
  // on both sides.
  const auto gap = [&](const PosePair& p) {
    return std::abs(truth[p.truth].timestamp - estimate[p.estimate].timestamp);
  };
  std::vector<PosePair> ordered;
  for (const PosePair& pair : pairs) {
    while (!ordered.empty() && ordered.back().truth > pair.truth && gap(pair) < gap(ordered.back())) ordered.pop_back();
    if (ordered.empty() || ordered.back().truth < pair.truth) ordered.push_back(pair);
  }
  return ordered;
}

Status align_points(const std::vector<Vector>& from, const std::vector<Vector>& to, bool with_scale, Similarity* out) {
  const std::size_t n = from.size();
  if (n < 3 || to.size() != n) return Status::too_few;
  Moments m;
  if (!find_moments(
          n, [&](std::size_t i) { return from[i]; }, [&](std::size_t i) { return to[i]; }, &m))
    return Status::non_finite;
  if (m.is_single_place()) return Status::degenerate;
  Similarity result;
  result.R = horn_rotation(m.correlation);
  // sum to . R from = trace(R correlation). It is negative only where a single point fits better than any rotation.
  if (with_scale) result.scale = (result.R * m.correlation).trace() / m.from_spread;
  return finish(m, result, out);
}

Status align_poses(const std::vector<SE3d>& from, const std::vector<SE3d>& to, Similarity* out) {
  const std::size_t n = from.size();
  if (n < 1 || to.size() != n) return Status::too_few;
  Moments m;
  if (!find_moments(
          n, [&](std::size_t i) { return from[i].t; }, [&](std::size_t i) { return to[i].t; }, &m))
    return Status::non_finite;
  Matrix3<double> turns = Matrix3<double>::Zero();
  for (std::size_t i = 0; i < n; ++i) turns += from[i].R * to[i].R.transpose();
  if (!textplane::all_finite(turns)) return Status::non_finite;
  Similarity result;
  result.scale = out->scale;
  if (m.is_single_place()) {
    result.R = horn_rotation(turns);
  } else {
    constexpr double kShare = 0.1;  // the traces of both are at most 1
    result.R = horn_rotation(m.correlation / std::sqrt(m.from_spread * m.to_spread) +
                             kShare / (3.0 * static_cast<double>(n)) * turns);
    result.scale = (result.R * m.correlation).trace() / m.from_spread;
  }
  return finish(m, result, out);
}

ErrorStatistics error_statistics(std::vector<double> errors) {
  ErrorStatistics statistics;
  statistics.n = errors.size();
  if (errors.empty()) return statistics;
  double squares = 0, sum = 0;
  for (const double e : errors) {
    squares += e * e;
    sum += e;
  }
  const double n = static_cast<double>(errors.size());
  statistics.rmse = std::sqrt(squares / n);
  statistics.mean = sum / n;
  std::sort(errors.begin(), errors.end());
  statistics.max = errors.back();
  statistics.median = quantile(errors, 0.5);
  statistics.p90 = quantile(errors, 0.9);
  return statistics;
}

TrajectoryEvaluation evaluate_trajectory(const std::vector<StampedPose>& estimate,
                                         const std::vector<StampedPose>& truth, std::size_t frames,
                                         const EvaluationOptions& options) {
  TrajectoryEvaluation result;
  if (frames > 0) result.coverage = static_cast<double>(estimate.size()) / static_cast<double>(frames);
  // Distance walked until each true pose.
  std::vector<double> walked(truth.size(), 0.0);
  for (std::size_t i = 1; i < truth.size(); ++i) {
    walked[i] = walked[i - 1] + (truth[i].T_w_c.t - truth[i - 1].T_w_c.t).norm();
  }

  const std::vector<PosePair> pairs = associate(estimate, truth, options.tolerance);
  result.pairs = pairs.size();
  if (!pairs.empty()) result.path_length = walked[pairs.back().truth] - walked[pairs.front().truth];
  std::vector<Vector> from, to;
  for (const PosePair& pair : pairs) {
    from.push_back(estimate[pair.estimate].T_w_c.t);
    to.push_back(truth[pair.truth].T_w_c.t);
  }
  result.status = align_points(from, to, options.with_scale, &result.alignment);
  if (!textplane::is_ok(result.status)) return result;

  std::vector<SE3d> aligned, reference;
  std::vector<double> errors, intervals;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    aligned.push_back(result.alignment * estimate[pairs[k].estimate].T_w_c);
    reference.push_back(truth[pairs[k].truth].T_w_c);
    errors.push_back((aligned[k].t - reference[k].t).norm());
    if (k > 0) intervals.push_back(truth[pairs[k].truth].timestamp - truth[pairs[k - 1].truth].timestamp);
  }
  result.ate = error_statistics(std::move(errors));

  result.frame_interval = median_of(intervals);
  RelativeErrors by_frame(aligned, reference), by_distance(aligned, reference);
  for (std::size_t k = 1; k < pairs.size(); ++k) {
    if (intervals[k - 1] <= 1.5 * result.frame_interval) by_frame.add(k - 1, k);
  }
  for (std::size_t i = 0, j = 0; i < pairs.size(); ++i) {
    while (j < pairs.size() && walked[pairs[j].truth] - walked[pairs[i].truth] < options.distance) ++j;
    if (j == pairs.size()) break;
    by_distance.add(i, j);
  }
  result.rpe_frame = by_frame.result();
  result.rpe_distance = by_distance.result();
  return result;
}

}  // namespace textslam
