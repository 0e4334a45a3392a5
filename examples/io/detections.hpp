// Text detections from files, one file a frame, in raw image pixels (before undistortion).
//
// The first of these files that exists is read; a frame without a file has no detections:
// - ICDAR, `x1,y1,x2,y2,x3,y3,x4,y4,text` a line, clockwise from the text's top left: <stem>.txt, res_<stem>.txt or
//   gt_<stem>.txt in detections/, then res_<stem>.txt or gt_<stem>.txt beside the image. The text is everything after
//   the eighth comma, further commas included. No text and `###` mean unread. In gt_<stem>.txt `###` marks what ICDAR
//   ignores: it is left out.
// - <stem>_dete.txt with <stem>_mean.txt, in detections/ or in text/: the pair that the published TextSLAM reads. The
//   first has eight numbers a line, the second `word,score` for the same boxes in the same order (split at the last
//   comma). Its boxes belong to the undistorted image; they are distorted here, so that all detections are raw pixels.
//   Without the second file the text is unread.
// Where the caller names a folder (Sequence::detections), only that one is searched; a video has no other.
// Blank lines are skipped; a byte-order mark and CR LF are accepted; bytes that are not UTF-8 become U+FFFD.
#ifndef TEXTSLAM_IO_DETECTIONS_HPP
#define TEXTSLAM_IO_DETECTIONS_HPP

#include <string>
#include <vector>

#include "io/sequence.hpp"
#include "textplane/landmarks/words.hpp"

namespace textslam {

using textplane::is_read;
using textplane::kUnreadText;  ///< The text of an unread detection.

struct Detection {
  Quad<double> quad;               ///< raw px, clockwise from the text's top left
  std::string text = kUnreadText;  ///< UTF-8
  double score = 1;                ///< of the recognition; the ICDAR format has none
};

/// Name of the ICDAR file with an image's truth.
inline std::string truth_name(const std::string& stem) { return "gt_" + stem + ".txt"; }

/// Their quads, in their order.
std::vector<Quad<double>> quads_of(const std::vector<Detection>& detections);

/// The detections of one frame. Throws InputError with file and line for a bad number, too few columns, or a pair whose
/// files do not have the same number of entries.
std::vector<Detection> read_detections(const Sequence& sequence, const FrameRef& frame);

/// Whether a folder of detections exists, or a file beside the first image.
bool has_detections(const Sequence& sequence);

/// The detections of one ICDAR file. Throws InputError as above, and when the file is missing.
std::vector<Detection> read_icdar(const std::string& path);

/// The ICDAR text; numbers survive the round trip exactly, scores are not part of the format, line breaks in a text
/// become spaces.
std::string format_detections(const std::vector<Detection>& detections);
/// Writes an ICDAR file as write_file() does.
void write_detections(const std::string& path, const std::vector<Detection>& detections);

}  // namespace textslam

#endif  // TEXTSLAM_IO_DETECTIONS_HPP
