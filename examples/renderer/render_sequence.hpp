// The renderer: sequences in the formats that textslam reads, with exact truth, from a name and a seed.
//
// A kind is rendered into a folder: images.txt, images/NNNNNN.png, camera.yaml, groundtruth.txt,
// detections/NNNNNN.txt, and
//   truth/signs.json          id, word, corners and normal in the world frame (m) of every sign that stands
//   truth/quads/NNNNNN.txt    the exact quads of the signs in view: x1,y1,...,x4,y4,text,sign,visible (raw px)
//   truth/frames.txt          timestamp, exposure (s), median and longest blur (px), gain, bias (grey levels)
// Ground truth is the pose in the middle of the exposure, behind a rolling shutter that of the middle row. The system
// never reads truth/.
#ifndef TEXTSLAM_RENDERER_RENDER_SEQUENCE_HPP
#define TEXTSLAM_RENDERER_RENDER_SEQUENCE_HPP

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "io/names.hpp"
#include "renderer/conditions.hpp"
#include "renderer/detector_model.hpp"

namespace textslam {

struct RenderOptions {
  std::string kind = "room";  ///< one of render_kinds()
  std::string output;         ///< the folder; created if missing, files in it are replaced
  std::uint64_t seed = 1;
  int walk = 0;    ///< Which visit to the scene, see walk.hpp.
  int frames = 0;  ///< at 30 a second; 0: default_frames() of kinds.hpp
  int width = 640,
      height =
          480;  ///< px; every size has the kind's field of view, by default that of 525 px focal length at width 640
  RadialTangential<double> lens;  ///< coefficients alone are read; by default the kind's
  Conditions conditions;
  DetectorErrors detector;
  int threads = 2;  ///< the bytes written do not depend on it
};

/// The names that RenderOptions::kind takes.
std::vector<std::string> render_kinds();

/// Renders the sequence. `progress`, if not empty, is called after every frame, one call at a time, with increasing
/// `done`. Throws InputError for an unknown kind or invalid sizes, std::runtime_error where no font is found (naming
/// the package to install) or a file cannot be written.
void render_sequence(const RenderOptions& options, const std::function<void(int done, int total)>& progress = {});

}  // namespace textslam

#endif  // TEXTSLAM_RENDERER_RENDER_SEQUENCE_HPP
