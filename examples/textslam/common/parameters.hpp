// Parameters: every number that the system works with. parameters.inc lists them; a new one is a line there.
#ifndef TEXTSLAM_COMMON_PARAMETERS_HPP
#define TEXTSLAM_COMMON_PARAMETERS_HPP

#include <algorithm>
#include <cmath>

#include "textplane/landmarks/text_options.hpp"
#include "textplane/photometry/pyramid.hpp"

namespace textslam {

enum class Mode {
  text,    ///< Points and text planes in one cost.
  points,  ///< Points alone; detections are not used.
  loose,   ///< The paper's comparison: poses and points as in `points`; text planes fitted to the points afterwards.
};

struct Parameters {
  textplane::TextOptions text;
#define SECTION(title)
#define FIELD(type, name, value, meaning) type name = value;
#define TEXT_FIELD(name, member, meaning)
#include "textslam/common/parameters.inc"
#undef TEXT_FIELD
#undef FIELD
#undef SECTION
};

/// The parameters for images of this size: what says "px at 640x480" is for images of that area, and grows with the
/// side of a square of equal area. The coarsest pyramid level stays about as small as that of 640x480.
inline Parameters at_size(Parameters parameters, int width, int height) {
  const double scale = std::sqrt(static_cast<double>(width) * height / (640.0 * 480.0));
  const auto pixels = [scale](int px) { return std::max(1, static_cast<int>(std::lround(px * scale))); };
  parameters.corner_cell = std::max(parameters.min_corner_cell, pixels(parameters.corner_cell));
  parameters.text_corner_cell = std::max(parameters.min_corner_cell, pixels(parameters.text_corner_cell));
  parameters.init_view_flow *= scale;
  parameters.init_rotation_scale *= scale;
  parameters.keyframe_flow *= scale;
  parameters.relocation_search *= scale;
  parameters.normal_reach *= scale;
  parameters.loop_max_shift *= scale;
  const double levels = std::log2(std::min(width, height) / static_cast<double>(parameters.coarsest_side));
  parameters.pyramid_levels =
      std::clamp(1 + static_cast<int>(levels), parameters.text.levels, textplane::kMaxPyramidLevels);
  return parameters;
}

/// Calls visit(section, name, value, meaning) for each parameter, in the order of the list.
template <class Visit>
void for_each_parameter(const Parameters& parameters, Visit visit) {
  const char* section = "";
#define SECTION(title) section = title;
#define FIELD(type, name, value, meaning) visit(section, #name, parameters.name, meaning);
#define TEXT_FIELD(name, member, meaning) visit(section, #name, parameters.text.member, meaning);
#include "textslam/common/parameters.inc"
#undef TEXT_FIELD
#undef FIELD
#undef SECTION
}

}  // namespace textslam

#endif  // TEXTSLAM_COMMON_PARAMETERS_HPP
