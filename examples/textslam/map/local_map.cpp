#include "textslam/map/local_map.hpp"

#include <algorithm>

#include "textslam/map/observations.hpp"

namespace textslam {
namespace {

class Neighbourhood {
 public:
  Neighbourhood(const Map& map, const Parameters& parameters) : map_(map), parameters_(parameters) {
    found_.keyframe_in.assign(map.keyframes.size(), 0);
    texts_of_.resize(map.keyframes.size());
    for (const TextObject& text : map.texts) {
      if (text.state != TextState::mapped) continue;
      texts_of_[static_cast<std::size_t>(text.host)].push_back(text.id);
      for (const int id : text.views) texts_of_[static_cast<std::size_t>(id)].push_back(text.id);
    }
  }

  // Takes in the key frames that share enough with the given points and texts; those that are new.
  std::vector<int> add_around(const std::vector<int>& points, const std::vector<int>& texts) {
    std::vector<int> shared = shared_points(map_, points);
    for (const int id : texts) {
      const TextObject& text = map_.text(id);
      shared[static_cast<std::size_t>(text.host)] += parameters_.local_min_shared;
      for (const int view : text.views) shared[static_cast<std::size_t>(view)] += parameters_.local_min_shared;
    }
    std::vector<int> added;
    for (std::size_t i = 0; i < shared.size(); ++i)
      if (shared[i] >= parameters_.local_min_shared && add(static_cast<int>(i))) added.push_back(static_cast<int>(i));
    return added;
  }

  bool add(int keyframe) {
    char& in = found_.keyframe_in[static_cast<std::size_t>(keyframe)];
    if (in) return false;
    in = 1;
    return true;
  }

  std::vector<int> add_around(const std::vector<int>& keyframes) {
    std::vector<int> added;
    for (const int id : keyframes) {
      const std::vector<int> more = add_around(map_.keyframe(id).points, texts_of_[static_cast<std::size_t>(id)]);
      added.insert(added.end(), more.begin(), more.end());
    }
    return added;
  }

  LocalMap contents() {
    found_.point_in.assign(map_.points.size(), 0);
    found_.text_in.assign(map_.texts.size(), 0);
    for (std::size_t i = 0; i < map_.keyframes.size(); ++i) {
      if (!found_.keyframe_in[i]) continue;
      for (const int id : map_.keyframes[i].points) found_.point_in[static_cast<std::size_t>(id)] = 1;
    }
    for (const TextObject& text : map_.texts) {
      const auto is_in = [&](int keyframe) { return found_.keyframe_in[static_cast<std::size_t>(keyframe)] != 0; };
      if (is_in(text.host) || std::any_of(text.views.begin(), text.views.end(), is_in))
        found_.text_in[static_cast<std::size_t>(text.id)] = 1;
    }
    return std::move(found_);
  }

 private:
  const Map& map_;
  const Parameters& parameters_;
  std::vector<std::vector<int>> texts_of_;  // mapped texts of each key frame
  LocalMap found_;
};

}  // namespace

LocalMap local_map(const Map& map, const Parameters& parameters, int keyframe) {
  Neighbourhood around(map, parameters);
  around.add(keyframe);
  std::vector<int> reached = {keyframe};
  for (int hop = 0; hop < parameters.local_hops; ++hop) reached = around.add_around(reached);
  return around.contents();
}

LocalMap local_map(const Map& map, const Parameters& parameters, const std::vector<int>& points) {
  Neighbourhood around(map, parameters);
  std::vector<int> reached = around.add_around(points, {});
  for (int hop = 1; hop < parameters.local_hops; ++hop) reached = around.add_around(reached);
  return around.contents();
}

}  // namespace textslam
