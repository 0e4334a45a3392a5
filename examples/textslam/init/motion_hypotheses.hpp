// MotionHypotheses: motions that two views cannot tell apart, kept until more views do.
//
// Two motions explain two views of one plane equally well; further views contradict the wrong one. So each hypothesis
// is a small reconstruction of all views so far, and the robust reprojection errors are compared.
#ifndef TEXTSLAM_INIT_MOTION_HYPOTHESES_HPP
#define TEXTSLAM_INIT_MOTION_HYPOTHESES_HPP

#include <vector>

#include "textslam/track/track.hpp"

namespace textslam {

/// The ratio above which one sum of squares, of so many degrees of freedom, exceeds another by more than noise.
/// `sigmas`: standard deviations of the ratio of two independent sums.
double clear_ratio(double degrees_of_freedom, double sigmas);

class MotionHypotheses {
 public:
  explicit MotionHypotheses(const Parameters& parameters) : parameters_(parameters) {}

  bool empty() const { return hypotheses_.empty(); }
  bool won() const { return hypotheses_.size() == 1; }

  /// Motions from the reference a to a second view b, |t| = 1.
  void begin(const std::vector<SE3d>& T_b_a);

  /// Takes a further view. `tracks`: each with one observation a view, the newest last. `replaced`: the newest view
  /// replaces the one before. Drops hypotheses that are clearly worse than another, or the same as a better one.
  void judge(const std::vector<Track>& tracks, const CameraView& camera, bool replaced);

  // Of the best hypothesis, as last judged.
  const SE3d& T_newest_a() const { return hypotheses_.front().T_c_a.back(); }
  /// Root mean square of the robust error, px.
  double rms() const { return hypotheses_.front().rms; }
  /// Per track: it fits in all views.
  const std::vector<char>& inlier() const { return hypotheses_.front().inlier; }

 private:
  struct Hypothesis {
    std::vector<SE3d> T_c_a;  // of each view; the first is the reference's, the identity
    double rms = 0;
    std::vector<char> inlier;
  };

  void add_view(const std::vector<Track>& tracks, const CameraView& camera, Hypothesis& hypothesis) const;
  void adjust(const std::vector<Track>& tracks, const CameraView& camera, Hypothesis& hypothesis) const;

  const Parameters& parameters_;
  std::vector<Hypothesis> hypotheses_;  // the best first
};

}  // namespace textslam

#endif  // TEXTSLAM_INIT_MOTION_HYPOTHESES_HPP
