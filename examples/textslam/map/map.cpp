#include "textslam/map/map.hpp"

#include "textslam/map/text_words.hpp"

namespace textslam {

std::string TextObject::word() const { return consensus(votes); }

std::vector<int> Map::keyframe_ids() const {
  std::vector<int> ids;
  for (std::size_t i = 0; i < keyframes.size(); ++i)
    if (!keyframes[i].culled) ids.push_back(static_cast<int>(i));
  return ids;
}

void Map::clear() {
  keyframes.clear();
  points.clear();
  texts.clear();
}

}  // namespace textslam
