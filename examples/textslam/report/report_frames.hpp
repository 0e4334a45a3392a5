// The pictures of the report: frames of the sequence with what was found in them, and the texts as seen from the front.
#ifndef TEXTSLAM_REPORT_REPORT_FRAMES_HPP
#define TEXTSLAM_REPORT_REPORT_FRAMES_HPP

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "textslam/common/report_json.hpp"
#include "textslam/system/system.hpp"

namespace textslam {

/// The image of a frame that was processed; the frame's index counts from the run's first.
using ImageSource = std::function<std::shared_ptr<const Pyramid>(int)>;

// Bounds on the size of the report. A frame takes up to 4/3 kFrameBytes and 10 kB of marks, a map point 40 B.
constexpr std::size_t kReportFrames = 300;      ///< Pictures; of a longer run, evenly spaced.
constexpr int kFrameSide = 320;                 ///< px, the longer side of a picture at most.
constexpr std::size_t kFrameBytes = 22 << 10;   ///< Of a picture's JPEG.
constexpr std::size_t kTextureBytes = 3 << 19;  ///< Of the JPEGs of all texts.
constexpr int kTextureSide = 192;               ///< px.

/// JPEG of the image, its longer side at most kFrameSide, at the best quality that fits kFrameBytes.
std::string frame_jpeg(const Pyramid& image);

/// JPEG of the text seen from the front: its quad of the host key frame, rectified through its plane.
std::string text_jpeg(const Map& map, const TextObject& text);

/// A frame shown: {"frame", "image", "detections":[{"quad","text"}], "points":[x,y,...],
/// "texts":[{"id","quad","zncc"}]}, px of the whole image; the mapped texts under the frame's pose, none without it.
/// Behind a lens the quad of such a text is curved: it has eight points an edge, from the first corner on.
Json frame_json(const Map& map, const Parameters& parameters, int index, const Pyramid& image,
                const std::vector<Detection>& detections, const std::vector<SeenPoint>& points,
                const std::optional<SE3d>& T_c_w);

/// The frames shown: the processed ones among the keys of `detections`, under their final poses.
Json frames_json(const System& system, const Parameters& parameters,
                 const std::map<int, std::vector<Detection>>& detections, const ImageSource& image);

/// Map points that key frame `id` observes, with where.
std::vector<SeenPoint> points_of_keyframe(const Map& map, int id);

/// Map points that the pose of a frame rests on, with where they were seen.
std::vector<SeenPoint> points_of(const System& system, std::size_t index);

}  // namespace textslam

#endif  // TEXTSLAM_REPORT_REPORT_FRAMES_HPP
