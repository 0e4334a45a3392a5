#include "textslam_eval/map_run.hpp"

#include <cmath>
#include <limits>

#include "io/evaluate_signs.hpp"
#include "io/input_error.hpp"
#include "io/json_file.hpp"
#include "io/sequence.hpp"

namespace textslam {
namespace {

Similarity alignment_of(const std::string& run) {
  const std::vector<StampedPose> poses = read_tum(run + "/trajectory.txt"),
                                 truth = read_tum(run + "/sequence/groundtruth.txt");
  const TrajectoryEvaluation evaluation = evaluate_trajectory(poses, truth, truth.size());
  if (!textplane::is_ok(evaluation.status))
    throw InputError(run, 0, std::string("cannot be aligned to its truth: ") + textplane::to_string(evaluation.status));
  return evaluation.alignment;
}

// To the nearest sign within 45 degrees before the camera; infinity where there is none.
double depth_before(const SE3d& T_w_c, const std::vector<TrueSign>& signs) {
  double nearest = std::numeric_limits<double>::infinity();
  const SE3d T_c_w = T_w_c.inverse();
  for (const TrueSign& sign : signs) {
    const Vector3<double> centre = (sign.corners[0] + sign.corners[1] + sign.corners[2] + sign.corners[3]) / 4;
    const Vector3<double> p = T_c_w * centre;
    if (p.z() > p.head<2>().norm()) nearest = std::min(nearest, p.z());
  }
  return nearest;
}

}  // namespace

LocalisedEvaluation evaluate_localised(const std::string& run, const std::string& truth_folder,
                                       const std::string& map_run) {
  constexpr double kDegrees = 180 / 3.14159265358979323846;
  const Similarity alignment = alignment_of(map_run);
  const std::string sequence = truth_folder.empty() ? run + "/sequence" : truth_folder;
  const std::vector<StampedPose> poses = read_tum(run + "/trajectory.txt"),
                                 truth = read_tum(sequence + "/groundtruth.txt");
  const std::vector<TrueSign> signs = read_true_signs(sequence, {}, {});
  LocalisedEvaluation out;
  out.run = run;
  out.frames = truth.size();
  out.localised = poses.size();
  std::vector<double> shifts, turns;
  for (const PosePair& pair : associate(poses, truth, EvaluationOptions{}.tolerance)) {
    if (out.first < 0) out.first = static_cast<int>(pair.truth);
    const SE3d found = alignment * poses[pair.estimate].T_w_c;
    const SE3d& right = truth[pair.truth].T_w_c;
    shifts.push_back((found.t - right.t).norm());
    turns.push_back(textplane::so3_log<double>(found.R.transpose() * right.R).norm() * kDegrees);
    const bool wrong = !(shifts.back() <= kWrongShare * depth_before(right, signs) && turns.back() <= kWrongDegrees);
    out.wrong += wrong ? 1 : 0;
  }
  out.judged = shifts.size();
  out.position = error_statistics(std::move(shifts));
  out.rotation = error_statistics(std::move(turns));
  return out;
}

std::string format_localised(const LocalisedEvaluation& e) {
  return nlohmann::json{{"run", e.run},
                        {"frames", e.frames},
                        {"localised", e.localised},
                        {"first", e.first},
                        {"judged", e.judged},
                        {"wrong", e.wrong},
                        {"position_rmse", e.position.rmse},
                        {"position_median", e.position.median},
                        {"position_p90", e.position.p90},
                        {"position_max", e.position.max},
                        {"rotation_median_deg", e.rotation.median},
                        {"rotation_max_deg", e.rotation.max}}
             .dump() +
         "\n";
}

}  // namespace textslam
