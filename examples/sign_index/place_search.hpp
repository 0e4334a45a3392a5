// Place search: where is a camera that sees these signs?
//
// Words lead to signs of the index, tolerant of reading errors. The quad of one sign, whose plane and size the map
// knows, gives a pose; the signs around it must then fall where others were detected (the constellation). Bayes' rule
// weighs all places found, and the chance that the camera is somewhere else: by what was read, against readings of
// unknown words, and by where the corners fall, against quads anywhere in the image.
#ifndef TEXTSLAM_SIGN_INDEX_PLACE_SEARCH_HPP
#define TEXTSLAM_SIGN_INDEX_PLACE_SEARCH_HPP

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "io/camera_model.hpp"
#include "io/detections.hpp"
#include "sign_index/sign_index.hpp"
#include "sign_index/sign_pose.hpp"
#include "textplane/core/status.hpp"

namespace textslam {

struct PlaceOptions {
  double corner_sigma = 1.5;          ///< px, of each coordinate of a detected corner
  double least_probability = 0.9999;  ///< An answer is given from here on.
  double in_map = 0.5;                ///< Probability, before the query, that the camera is in the map.
  double unmapped = 0.5;              ///< Mean number of quads in an image that are no signs of the map.
  double missed = 0.35;               ///< Share of the signs in view that are not detected, or hidden.
  std::optional<Upright> upright;     ///< What is known of how the camera is held; by default nothing.
  int most_words = 60;                ///< Words that a reading may stand for.
  int most_seeds = 500;               ///< Pairs of a detection and a sign that poses are computed from.
  int most_places = 5;                ///< in the answer
};

struct SignSighting {
  int detection;       ///< its number in the query
  std::uint32_t sign;  ///< its number in the index
};

struct FoundPlace {
  SE3d T_c_w;
  Matrix6 covariance = Matrix6::Zero();  ///< of the left perturbation of T_c_w
  double probability = 0;                ///< that the camera sees these signs
  double pose_share = 1;                 ///< Probability of this pose, given the signs: one quad allows two.
  double log_evidence = 0;               ///< against a camera that is elsewhere
  std::vector<SignSighting> sightings;
};

struct PlaceAnswer {
  /// ok: there is an answer, places.front(). diverged: there is none that is probable enough; `places` are the best
  /// guesses. too_few: no quad that is whole, or none was read. non_finite: a corner is not; invalid_argument: options
  /// out of range, or a camera without an image size.
  textplane::Status status = textplane::Status::too_few;
  std::vector<FoundPlace> places;  ///< the most probable first
};

/// Searches one index; a thread needs one of its own.
class PlaceSearch {
 public:
  explicit PlaceSearch(const SignIndex& index, const PlaceOptions& options = {});
  ~PlaceSearch();
  PlaceSearch(PlaceSearch&&) noexcept;

  /// Quads that touch the edge of the image are cut off: their corners are not used.
  PlaceAnswer find(const std::vector<Detection>& detections, const CameraModel& camera);

 private:
  class Engine;
  std::unique_ptr<Engine> engine_;
};

}  // namespace textslam

#endif  // TEXTSLAM_SIGN_INDEX_PLACE_SEARCH_HPP
