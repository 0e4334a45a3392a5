#include "textslam/report/localisation.hpp"

#include <cstdio>

namespace textslam {

const char* to_string(FoundBy by) {
  switch (by) {
    case FoundBy::tracking: return "tracking";
    case FoundBy::texts: return "texts";
    case FoundBy::images: return "images";
    case FoundBy::points: return "points";
    case FoundBy::nothing: break;
  }
  return "nothing";
}

std::string localisation_table(const System& system) {
  std::string out = "timestamp,found_by,points,texts,position_sigma\n";
  char line[128];
  for (const FrameRecord& record : system.records()) {
    const bool found = record.state == FrameState::tracked;
    std::snprintf(line, sizeof line, "%.6f,%s,%d,%d,", record.timestamp, to_string(record.by),
                  found ? record.points : 0, found ? record.texts : 0);
    out += line;
    if (found) {
      std::snprintf(line, sizeof line, "%.6e", record.position_sigma);
      out += line;
    }
    out += '\n';
  }
  return out;
}

}  // namespace textslam
