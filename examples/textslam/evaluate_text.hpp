// Text maps against the exact signs of a rendered sequence. Runs after the map is final; the system never sees the truth.
#ifndef TEXTSLAM_EVALUATE_TEXT_HPP
#define TEXTSLAM_EVALUATE_TEXT_HPP

#include <array>
#include <string>
#include <vector>

#include "io/evaluate.hpp"
#include "io/sequence.hpp"
#include "textslam/map.hpp"

namespace textslam {

/// A true sign, in the world frame of the truth.
struct TrueSign {
  int id = -1;
  std::string word;
  std::array<Vec3, 4> corners;
  Vec3 normal;
  int visible_frames = 0;  ///< Frames that show it whole.
};

struct SignMatch {
  int text = -1;      ///< Id in the text map.
  int sign = -1;      ///< Id of the true sign; -1: there is none where the text stands.
  double angle = 0;   ///< Degrees between the normals.
  double centre = 0;  ///< Distance of the centres, in units of the truth.
  bool word = false;  ///< The word is right.
};

struct TextEvaluation {
  bool available = false;   ///< The sequence has true signs and the trajectory could be aligned.
  int signs = 0;            ///< Signs visible long enough to be mapped.
  int mapped = 0;           ///< Of them, those that a text stands for.
  int false_texts = 0;      ///< Texts where no sign is.
  double median_angle = 0;  ///< Degrees, over the matched texts.
  double max_angle = 0;
  double median_centre = 0;
  std::vector<SignMatch> matches;
};

/// The signs in the folder truth of a sequence, or none where there is no such folder. Throws InputError for a broken file.
std::vector<TrueSign> read_true_signs(const Sequence& sequence);

/// Matches the mapped texts to the signs after `alignment` (map to truth).
TextEvaluation evaluate_text(const Map& map, const std::vector<TrueSign>& signs, const Similarity& alignment);

/// World positions of the corners of a text that has a plane.
std::array<Vec3, 4> world_corners(const Map& map, const TextObject& text);

}  // namespace textslam

#endif  // TEXTSLAM_EVALUATE_TEXT_HPP
