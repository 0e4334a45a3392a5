// Published sets of photographs of planar scenes, with the homographies between them.
#ifndef TEXTPLANE_EXAMPLES_PHOTO_SETS_HPP
#define TEXTPLANE_EXAMPLES_PHOTO_SETS_HPP

#include <cstdint>
#include <string>
#include <vector>

#include "planar/plane_tracker.hpp"

namespace planar {

constexpr double kBorder = 12;  ///< px: patches keep that far from the borders of an image.

/// A photograph, others of the same planar scene, and the true homographies to them (px).
struct PhotoSet {
  std::string first;
  std::vector<std::string> others;
  std::vector<tp::Matrix3<double>> truth;
  std::vector<tp::Vector2<double>> not_text;  ///< px of the first: detections here hold no text and are dropped.
  std::vector<int> jpeg;  ///< Quality that the others are degraded to; empty: they are taken as they are.
  bool text = true;       ///< Patches are text that the built-in detector finds; else random places rich in corners.
};

/// How precise the truth of a folder of scenes is (registration.hpp), px: the mean distance of a match from it, and the
/// mean and largest distance, at the patches, of the map from photograph 0 to j and the one by way of another, i.
struct TruthPrecision {
  double residual = 0, round_trip = 0, largest_round_trip = 0;
};

/// A folder of scene_NNNN folders, photographs of a camera that hardly moves. `not_text`: "scene,x,y", scenes
/// counted from 0. Throws InputError.
std::vector<PhotoSet> read_still_scenes(const std::string& folder, const std::vector<std::string>& not_text,
                                        TruthPrecision* precision);
/// img1.png to img6.png with H1to2p.txt to H1to6p.txt. Throws InputError.
std::vector<PhotoSet> read_oxford(const std::string& folder);

/// The first photograph of each folder of read_oxford(), and JPEG of these qualities made of it.
std::vector<PhotoSet> make_jpeg(const std::vector<std::string>& folders, const std::vector<int>& qualities);

/// The quads of text that the built-in detector finds, large enough for a trial, but those round a point of `not_text`.
std::vector<tp::Quad<double>> text_quads(const tp::Image<std::uint8_t>& image,
                                         const std::vector<tp::Vector2<double>>& not_text);

}  // namespace planar

#endif  // TEXTPLANE_EXAMPLES_PHOTO_SETS_HPP
