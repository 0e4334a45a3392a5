// The text map as outputs: text_map.json, text_map.ply, and the texts of the report. A new field of a text is a line in
// text_map.cpp; a line in examples/viewer/table.js shows it as a column.
#ifndef TEXTSLAM_REPORT_TEXT_MAP_HPP
#define TEXTSLAM_REPORT_TEXT_MAP_HPP

#include <string>

#include "textslam/report/summary.hpp"

namespace textslam {

/// {"texts":[{"id", "text", "corners", "normal", "theta", "host", "observations", "zncc", "normal_sigma_deg"}]} in the
/// world frame; `host`: the time stamp of its host key frame; `theta` is in that frame.
std::string text_map_json(const Map& map);

/// Text quads as faces, points and key frames as coloured vertices.
std::string text_map_ply(const Map& map);

/// [{"id", "word", "corners", "centre", "normal", "sigma_deg", "observations", "zncc", "host", "readings", "image",
/// "sign", "angle_deg", "centre_error", "word_right"}]; `host`: the index of a frame; `readings`: all that got votes;
/// `image`: null once the pictures exceed kTextureBytes; `sign` and the rest of those with a match; `sign` -1: there is
/// none.
Json page_texts(const Map& map, const std::vector<SignMatch>& matches);

}  // namespace textslam

#endif  // TEXTSLAM_REPORT_TEXT_MAP_HPP
