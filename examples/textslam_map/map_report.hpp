// report.html of a map file alone: the page of a run (textslam/report/report.hpp) whose frames are the key frames, with
// the sessions that they are from. In its JSON beside what a run has:
//
//   "sessions"           as `textslam-map info --json` has them, each with its "command"; a text counts for the session
//                        of its host
//   "series"."session"   the session of each key frame. They follow each other, each in the order of time.
#ifndef TEXTSLAM_MAP_MAP_REPORT_HPP
#define TEXTSLAM_MAP_MAP_REPORT_HPP

#include <string>
#include <vector>

#include "textslam/map_file/map_file.hpp"

namespace textslam {

/// The page of the map in `file`, which was loaded with `parameters`. `command`: the command line.
std::string map_report_html(LoadedMap loaded, const std::string& file, const Parameters& parameters,
                            const std::vector<std::string>& command);

}  // namespace textslam

#endif  // TEXTSLAM_MAP_MAP_REPORT_HPP
