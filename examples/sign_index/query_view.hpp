// Query view: the detections of one image as the search uses them, with the words that each reading may stand for.
#ifndef TEXTSLAM_SIGN_INDEX_QUERY_VIEW_HPP
#define TEXTSLAM_SIGN_INDEX_QUERY_VIEW_HPP

#include <cstdint>
#include <vector>

#include "io/camera_model.hpp"
#include "io/detections.hpp"
#include "sign_index/place_search.hpp"

namespace textslam {

struct WordEvidence {
  std::uint32_t word;
  double log_ratio;  ///< log P(reading | word) - log P(reading | sign of an unknown place)
};

/// A detection whose quad is whole.
struct QuerySign {
  int detection;
  Quad<double> quad;  ///< normalised
  Vec2 centre;        ///< normalised
  double area;        ///< px^2
  double log_peak;    ///< nats by which a sign that falls exactly there is likelier than a quad of an unknown place
  bool read;
  std::vector<WordEvidence> words;  ///< by word

  /// What the reading says for a sign of that word; 0 where nobody read either.
  double log_ratio(std::uint32_t word) const noexcept;
};

struct QueryView {
  textplane::Status status = textplane::Status::too_few;
  std::vector<QuerySign> signs;
  double sigma = 0;  ///< of a corner's coordinate, normalised
  Vec2 low, high;    ///< corners of the image, normalised
};

/// Status as PlaceAnswer has it.
QueryView make_query_view(const SignIndex& index, const PlaceOptions& options, const std::vector<Detection>& detections,
                          const CameraModel& camera, WordScratch* scratch);

}  // namespace textslam

#endif  // TEXTSLAM_SIGN_INDEX_QUERY_VIEW_HPP
