// TextObject: one planar text, as it lives in a map.
#ifndef TEXTPLANE_LANDMARKS_TEXT_OBJECT_HPP
#define TEXTPLANE_LANDMARKS_TEXT_OBJECT_HPP

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "textplane/core/numeric.hpp"
#include "textplane/photometry/patch.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// Where a text object is in its life. It goes from one state to the next, or is dropped; nothing goes back.
enum class TextState : std::uint8_t {
  candidate,  ///< Detected; its plane is not known yet.
  tentative,  ///< Has a plane, waits for the paper's n_min observations.
  mapped,     ///< Takes part in tracking and adjustment.
  dropped,    ///< Out of use for good; its id is not used again.
};

/// A planar text: a quad in its host key frame and the plane theta = -n / d in the host's frame.
struct TextObject {
  int id = -1;                                           ///< Never used twice.
  TextState state = TextState::candidate;                ///< See TextState.
  int host = -1;                                         ///< Id of the key frame that the patch was cut out of.
  TextPatch patch;                                       ///< Its pixels there, and its quad.
  Vector3<double> theta = Vector3<double>::Zero();       ///< The plane, in the host's frame.
  Matrix3<double> covariance = Matrix3<double>::Zero();  ///< Of theta.
  std::vector<int> views;               ///< Key frames, without the host, that observe it well; increasing.
  std::map<std::string, double> votes;  ///< Words read: sums of the scores of their readings (words.hpp).
  int detections = 0;                   ///< Frames in which the detector saw it.
  int shown = 0;                        ///< Frames with detections that could have shown it, those included.
  int failures = 0;                     ///< Key frames in a row that should have seen it and did not.
  double zncc = 0;                      ///< Mean over its last refinement.
  /// How much larger the variance of its residuals acts than that of as many independent pixels: views err as wholes.
  double variance_factor = 1;

  /// Whether theta is known.
  bool has_plane() const noexcept { return state == TextState::tentative || state == TextState::mapped; }
};

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_LANDMARKS_TEXT_OBJECT_HPP
