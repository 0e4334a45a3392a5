// FrameTurns: how a rolling shutter's rows moved where no pose is known yet: by the turns between frames.
//
// The turn that best aligns two images (rotation_prior.hpp) moves what is far away as it moved, and what is near
// nearly, whatever the camera's path was. So it undoes most of what the rows did.
#ifndef TEXTSLAM_TRACK_FRAME_TURNS_HPP
#define TEXTSLAM_TRACK_FRAME_TURNS_HPP

#include <algorithm>
#include <memory>

#include "textplane/core/row_motion.hpp"
#include "textslam/common/geometry.hpp"

namespace textslam {

class FrameTurns {
 public:
  /// Forgets all frames.
  void clear() { *this = FrameTurns(); }

  /// The newest frame is `seconds` after the one before, and R_newest_before the turn between them.
  void add(const Eigen::Matrix3d& R_newest_before, double seconds) {
    const Vec3 turn = textplane::so3_log<double>(R_newest_before) / seconds;
    const double share = seconds_ > 0 ? seconds / (seconds + seconds_) : 0;
    // Turns are those halfway between frames.
    const Vec3 change = seconds_ > 0 ? Vec3(turn - turn_) : Vec3::Zero();
    unsure_ = unsure_before_ = 0.5 * (seconds_ > 0 ? change : turn).norm();
    if (spacing_ > 0) {
      // By this the change is not an even one. The error of the line through two turns is a third of it at the newest
      // frame, and a sixth at the one before, while that goes on.
      const double uneven = (change - change_ * (seconds + seconds_) / spacing_).norm(),
                   larger = std::max(uneven, uneven_);
      unsure_ = larger / 3;
      unsure_before_ = larger / 6;
      uneven_ = uneven;
    }
    newest_ = turn + share * change;
    before_ = turn - share * change;
    spacing_ = seconds_ > 0 ? seconds + seconds_ : 0;
    turn_ = turn;
    change_ = change;
    seconds_ = seconds;
  }

  /// Radians a s, at the newest frame and at the one before it; of the last add().
  const Vec3& newest() const { return newest_; }
  const Vec3& before() const { return before_; }
  /// By how much these may be wrong, radians a s: by how unevenly the last three turns changed. Of two turns half of
  /// what changed, of the first half of itself.
  double unsure() const { return unsure_; }
  double unsure_before() const { return unsure_before_; }

 private:
  Vec3 turn_ = Vec3::Zero(), change_ = Vec3::Zero(), newest_ = Vec3::Zero(), before_ = Vec3::Zero();
  double unsure_ = 0, unsure_before_ = 0, uneven_ = 0;
  double seconds_ = 0;  // between the last two frames; 0: there are none
  double spacing_ = 0;  // of the last three, from the first to the last; 0: there are none
};

/// The rows of a camera that only turns.
inline std::shared_ptr<const textplane::RowMotion> turning_rows(const Vec3& omega,
                                                                const textplane::RollingShutter& shutter) {
  textplane::RowMotion motion{Vector6::Zero(), shutter};
  motion.velocity.tail<3>() = omega;
  return std::make_shared<const textplane::RowMotion>(motion);
}

}  // namespace textslam

#endif  // TEXTSLAM_TRACK_FRAME_TURNS_HPP
