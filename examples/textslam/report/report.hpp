// report.html: one page that shows a run, without a network. The page is examples/viewer, built into the program, with
// two blocks of JSON:
//
//   <script id="data">  the map, the frames, the parameters: the same bytes whenever the run is the same
//   <script id="run">   what may differ between equal runs: the command line, the sequence's folder, the SIMD target,
//                       the milliseconds
//
// What is in them: summary.hpp, text_map.hpp, report_data.hpp, report_frames.hpp, timing.hpp. The page of a map without
// a run has less: textslam_map/map_report.hpp.
#ifndef TEXTSLAM_REPORT_REPORT_HPP
#define TEXTSLAM_REPORT_REPORT_HPP

#include <map>
#include <string>
#include <vector>

#include "textslam/report/report_frames.hpp"
#include "textslam/report/summary.hpp"

namespace textslam {

struct ReportInput {
  const System& system;  ///< After finish() and fill_in().
  const Parameters& parameters;
  const Sequence& sequence;
  const RunSummary& summary;
  const std::vector<TrueSign>& signs;                       ///< Empty where they are not known.
  const std::map<int, std::vector<Detection>>& detections;  ///< By the frames that may be shown.
  ImageSource image;                                        ///< Called once for each picture.
  const std::vector<std::string>& command;                  ///< The command line, the program's name first.
  int first = 0, last = -1;                                 ///< Indices in the sequence of the frames.
  int every = 1;                                            ///< One frame of so many was used.
};

/// {"width", "height", "fx", "fy", "cx", "cy"}, px, and where it is guessed (not 0) "approximate_fov_deg".
Json camera_json(const CameraModel& camera, double approximate_fov);

/// The page with these two blocks.
std::string report_page(const Json& data, const Json& run);

/// The page. Throws what `image` throws.
std::string report_html(const ReportInput& input);

}  // namespace textslam

#endif  // TEXTSLAM_REPORT_REPORT_HPP
