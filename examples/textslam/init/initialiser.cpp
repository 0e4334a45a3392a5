#include "textslam/init/initialiser.hpp"

#include "textslam/track/rotation_prior.hpp"

namespace textslam {

bool Initialiser::add(const Frame& frame, Map& map, std::vector<Track>* tracks) {
  if (starts_.empty()) {
    turns_.clear();
    last_ = frame;
    starts_.emplace_back(frame, map.camera, parameters_);
    return false;
  }
  const RotationPrior prior = find_rotation(last_, frame, map.camera, Eigen::Matrix3d::Identity(), parameters_);
  for (MapStart& start : starts_) start.follow(last_, frame, prior.R_b_a, map.camera);
  Frame newest = frame;
  if (is_rolling(map, parameters_)) roll(prior.R_b_a, map.shutter, &newest);
  last_ = std::move(newest);

  const auto over = [](const MapStart& start) { return start.over(); };
  starts_.remove_if(over);
  if (!starts_.empty() && starts_.front().build(last_, turns_.unsure(), map, tracks)) {
    beside_ = starts_.front().beside();
    forget();
    return true;
  }
  starts_.remove_if(over);
  if (wants_reference()) starts_.emplace_back(last_, map.camera, parameters_);
  return false;
}

void Initialiser::add_detections(int frame, const std::vector<Detection>& detections, const CameraView& camera) {
  for (MapStart& start : starts_)
    if (start.reference().index == frame) start.add_detections(detections, camera, last_);
}

// The rows of the newest frame, and of a reference that is the one before.
void Initialiser::roll(const Eigen::Matrix3d& R_newest_last, const textplane::RollingShutter& shutter, Frame* newest) {
  const double seconds = newest->timestamp - last_.timestamp;
  if (!(seconds > 0)) return;
  turns_.add(R_newest_last, seconds);
  newest->rows = turning_rows(turns_.newest(), shutter);
  for (MapStart& start : starts_)
    if (start.reference().index == last_.index)
      start.know_rows(turning_rows(turns_.before(), shutter), turns_.unsure_before());
}

// Whether the newest frame is to be another.
bool Initialiser::wants_reference() const {
  if (starts_.empty()) return true;
  return starts_.back().share() < parameters_.init_next_share &&
         static_cast<int>(starts_.size()) < parameters_.init_references;
}

}  // namespace textslam
