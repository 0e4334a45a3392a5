// How the frames of a run were found: localisation.csv of `textslam --localise`.
#ifndef TEXTSLAM_REPORT_LOCALISATION_HPP
#define TEXTSLAM_REPORT_LOCALISATION_HPP

#include <string>

#include "textslam/system/system.hpp"

namespace textslam {

/// nothing, tracking, texts, images or points.
const char* to_string(FoundBy by);

/// A line a frame: timestamp, found_by, points, texts, position_sigma (of the camera, as a share of the scene's depth;
/// empty where no pose was found).
std::string localisation_table(const System& system);

}  // namespace textslam

#endif  // TEXTSLAM_REPORT_LOCALISATION_HPP
