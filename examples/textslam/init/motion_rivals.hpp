// MotionRivals: motions that two views cannot tell apart, kept until more views do.
//
// Corners of one plane leave two motions that explain two views alike, and the noise decides which costs less. In further views
// the wrong one has a wrong plane, and no pose makes up for that. Each rival therefore is a small reconstruction of its own:
// the poses of all views so far, adjusted with the corners' points, and its robust reprojection error over all of them is what
// is compared.
#ifndef TEXTSLAM_INIT_MOTION_RIVALS_HPP
#define TEXTSLAM_INIT_MOTION_RIVALS_HPP

#include <vector>

#include "textslam/common/parameters.hpp"
#include "textslam/map/map.hpp"

namespace textslam {

/// A sum of squared errors with so many degrees of freedom is larger than another by more than noise where their ratio is above
/// this; `sigmas`: standard deviations of the ratio of two independent ones.
double clear_ratio(double degrees_of_freedom, double sigmas);

class MotionRivals {
 public:
  explicit MotionRivals(const Parameters& parameters) : parameters_(parameters) {}

  bool empty() const { return rivals_.empty(); }
  bool won() const { return rivals_.size() == 1; }
  void clear() { rivals_.clear(); }

  /// Motions from the reference a to a second view b, |t| = 1.
  void begin(const std::vector<SE3d>& T_b_a);

  /// Takes a further view. `tracks`: each with one observation a view, in their order, the newest last; where the newest takes
  /// the place of the one before, `replaced`. Rivals that explain all views clearly worse than another go, and those that have
  /// become the same as a better one.
  void judge(const std::vector<Track>& tracks, const Pinhole<double>& camera, bool replaced);

  // Of the best rival, as last judged.
  const SE3d& T_newest_a() const { return rivals_.front().T_c_a.back(); }
  /// Root mean square of the robust error, px.
  double rms() const { return rivals_.front().rms; }
  /// Per track: it fits in all views.
  const std::vector<char>& inlier() const { return rivals_.front().inlier; }

 private:
  struct Rival {
    std::vector<SE3d> T_c_a;  // of each view; the first is the reference's, the identity
    double rms = 0;
    std::vector<char> inlier;
  };

  void add_view(const std::vector<Track>& tracks, const Pinhole<double>& camera, Rival& rival) const;
  void adjust(const std::vector<Track>& tracks, const Pinhole<double>& camera, Rival& rival) const;

  const Parameters& parameters_;
  std::vector<Rival> rivals_;  // the best first
};

}  // namespace textslam

#endif  // TEXTSLAM_INIT_MOTION_RIVALS_HPP
