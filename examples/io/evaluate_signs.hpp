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
#include "io/frame_list.hpp"

namespace textslam {

/// A true sign, in the world frame of the truth.
struct TrueSign {
  int id = -1;
  std::string word;
  std::array<Vector3<double>, 4> corners;
  Vector3<double> normal;
  double radius = 0;       ///< Of the cylinder that it is written on; 0: flat. One that is not flat is no sign.
  int visible_frames = 0;  ///< Frames that show it whole.
  int clear_frames =
      0;                ///< Of them, those that show it whole, 9 px high and wide, and slanted by less than 72 degrees.
  double parallax = 0;  ///< Degrees: the largest angle between the views of its centre in these frames.

  /// 20 clear frames with 3 degrees of parallax: enough to map it.
  bool is_clear() const { return clear_frames >= 20 && parallax >= 3 && !(radius > 0); }
};

/// A text of a map, in the map's world frame.
struct MappedText {
  int id = -1;
  std::string word;
  std::array<Vector3<double>, 4> corners;
  Vector3<double> normal;
  double sigma = 0;  ///< Stated standard deviation of the normal, degrees; 0: not stated.
};

struct SignMatch {
  int text = -1;      ///< Id in the text map.
  int sign = -1;      ///< Id of the true sign; -1: none.
  double angle = 0;   ///< Degrees between the normals.
  double sigma = 0;   ///< Stated for it; 0: not stated.
  double centre = 0;  ///< Distance of the centres, in units of the truth.
  bool word = false;  ///< The word is right.
};

struct TextEvaluation {
  bool available = false;            ///< The sequence has true signs and the trajectory could be aligned.
  int signs = 0;                     ///< Signs visible long enough to be mapped.
  int mapped = 0;                    ///< Of them, those with a text.
  int clear = 0;                     ///< Signs that are clear, see TrueSign.
  int clear_mapped = 0;              ///< Of them, those with a text.
  int false_texts = 0;               ///< Texts without a sign.
  ErrorStatistics angle;             ///< Degrees, over the matched texts.
  ErrorStatistics centre;            ///< Units of the truth, over the matched texts.
  ErrorStatistics angle_over_sigma;  ///< Over those that state a sigma. 1.2 in the median where it is right both ways.
  std::vector<SignMatch> matches;
};

/// The signs in the folder truth of a sequence; none where it has no signs.json. `frames`: those that count for
/// visible_frames, and for clear_frames where `truth` has their poses. Throws InputError for a broken file.
std::vector<TrueSign> read_true_signs(const std::string& folder, const std::vector<FrameRef>& frames,
                                      const std::vector<StampedPose>& truth);

/// The texts of a text_map.json. Throws InputError for a broken file.
std::vector<MappedText> read_text_map(const std::string& path);

/// Matches the texts to the signs after `alignment` (map to truth). A text belongs to the nearest sign, if its centre
/// is at most half the sign's width away. A text on a sign that is not flat is false: no plane is right.
TextEvaluation evaluate_texts(const std::vector<MappedText>& texts, const std::vector<TrueSign>& signs,
                              const Similarity& alignment);

}  // namespace textslam

#endif  // TEXTSLAM_IO_EVALUATE_SIGNS_HPP
