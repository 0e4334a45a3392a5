// Where was an image taken? Its signs name places of a map, and key frames may look like it; the answer is the pose
// from which the image shows most of the map.
#ifndef TEXTSLAM_MAP_FIND_IMAGE_HPP
#define TEXTSLAM_MAP_FIND_IMAGE_HPP

#include <optional>
#include <string>
#include <vector>

#include "sign_index/place_search.hpp"
#include "textslam/map_file/map_file.hpp"
#include "textslam/relocalise/relocalisation.hpp"

namespace textslam {

/// Unless found by something, nothing else counts.
struct ImageAnswer {
  std::string image;
  FoundBy by = FoundBy::nothing;
  SE3d T_w_c;
  double position_sigma = 0;  ///< Of the camera, as a share of the scene's depth.
  int texts = 0, points = 0;  ///< That the image shows where the pose expects them.
  /// That the image shows these signs of the map, by what was read and where it stands alone, before any pixel was
  /// compared. None where signs alone do not lead there.
  std::optional<double> probability;
  std::vector<std::string> words;  ///< The signs of that place that were detected, as the map reads them.
};

/// Finds images in one map, which outlives it. For one thread.
class ImageFinder {
 public:
  explicit ImageFinder(const LoadedMap& map);
  ImageFinder(const ImageFinder&) = delete;
  ImageFinder& operator=(const ImageFinder&) = delete;

  /// `image`: of the map's camera.
  ImageAnswer find(Image<std::uint8_t> image, std::vector<Detection> detections);

 private:
  /// Takes the place of the answer's pose, if one of these is.
  void name_place(const std::vector<FoundPlace>& places, const std::vector<Detection>& detections,
                  ImageAnswer* answer) const;

  const LoadedMap& map_;
  Parameters parameters_;
  SignIndex index_;
  std::optional<PlaceSearch> search_;  // none: no sign of the map was read
};

/// For people, and as JSON.
std::string answer_text(const ImageAnswer& answer);
std::string answers_json(const std::vector<ImageAnswer>& answers);

}  // namespace textslam

#endif  // TEXTSLAM_MAP_FIND_IMAGE_HPP
