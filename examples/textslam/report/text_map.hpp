// The text map as outputs: text_map.json, text_map.ply, and the texts of the report. A field of a text is a line of describe() in
// text_map.cpp, and a column of examples/viewer/table.js where the page is to show it.
#ifndef TEXTSLAM_REPORT_TEXT_MAP_HPP
#define TEXTSLAM_REPORT_TEXT_MAP_HPP

#include <string>

#include "textslam/report/summary.hpp"

namespace textslam {

/// {"texts":[{"id", "text", "corners", "normal", "theta", "host", "observations", "zncc", "normal_sigma_deg"}]}, world frame;
/// `host`: a time stamp.
std::string text_map_json(const Map& map);

/// Text quads as faces, points and key frames as coloured vertices.
std::string text_map_ply(const Map& map);

/// [{"id", "word", "corners", "centre", "normal", "sigma_deg", "observations", "zncc", "host", "image", "sign", "angle_deg",
/// "centre_error", "word_right"}]: sign and what follows only where the truth is known; sign -1: none stands there; `host`: a
/// frame; `image`: null once the pictures are beyond kTextureBytes.
Json page_texts(const System& system, const RunSummary& summary);

}  // namespace textslam

#endif  // TEXTSLAM_REPORT_TEXT_MAP_HPP
