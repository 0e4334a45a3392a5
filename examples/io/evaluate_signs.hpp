// Text maps against the exact signs of a rendered sequence: the sign of each text, and the error of its plane.
//
// Truth, in the folder of a sequence (see renderer/render_sequence.hpp):
//   truth/signs.json          {"signs":[{"id","text","corners":[[x,y,z],... 4],"normal":[x,y,z],"radius"},...]}
//   truth/quads/<stem>.txt    optional: x1,y1,...,x4,y4,text,sign,visible a line, the signs in each frame
#ifndef TEXTSLAM_IO_EVALUATE_SIGNS_HPP
#define TEXTSLAM_IO_EVALUATE_SIGNS_HPP

#include <array>
#include <string>
#include <vector>

#include "io/evaluate.hpp"

namespace textslam {

/// A true sign, in the world frame of the truth.
struct TrueSign {
  int id = -1;
  std::string word;
  std::array<Vector3<double>, 4> corners;
  Vector3<double> normal;
  double radius = 0;       ///< Of the cylinder that it is written on; 0: flat. One that is not flat is no sign.
  int visible_frames = 0;  ///< Frames that show it whole.
};

/// A text of a map, in the map's world frame.
struct MappedText {
  int id = -1;
  std::string word;
  std::array<Vector3<double>, 4> corners;
  Vector3<double> normal;
};

struct SignMatch {
  int text = -1;      ///< Id in the text map.
  int sign = -1;      ///< Id of the true sign; -1: none.
  double angle = 0;   ///< Degrees between the normals.
  double centre = 0;  ///< Distance of the centres, in units of the truth.
  bool word = false;  ///< The word is right.
};

struct TextEvaluation {
  bool available = false;  ///< The sequence has true signs and the trajectory could be aligned.
  int signs = 0;           ///< Signs visible long enough to be mapped.
  int mapped = 0;          ///< Of them, those with a text.
  int false_texts = 0;     ///< Texts without a sign.
  ErrorStatistics angle;   ///< Degrees, over the matched texts.
  ErrorStatistics centre;  ///< Units of the truth, over the matched texts.
  std::vector<SignMatch> matches;
};

/// The signs in the folder truth of a sequence; none where it has no signs.json. `stems`: the frames that count for
/// visible_frames. Throws InputError for a broken file.
std::vector<TrueSign> read_true_signs(const std::string& folder, const std::vector<std::string>& stems);

/// The texts of a text_map.json. Throws InputError for a broken file.
std::vector<MappedText> read_text_map(const std::string& path);

/// Matches the texts to the signs after `alignment` (map to truth). A text belongs to the nearest sign, if its centre
/// is at most half the sign's width away. A text on a sign that is not flat is false: no plane is right.
TextEvaluation evaluate_texts(const std::vector<MappedText>& texts, const std::vector<TrueSign>& signs,
                              const Similarity& alignment);

}  // namespace textslam

#endif  // TEXTSLAM_IO_EVALUATE_SIGNS_HPP
