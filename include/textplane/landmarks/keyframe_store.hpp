// KeyframeStore: the key frames of a TextMap, by the host's ids.
#ifndef TEXTPLANE_LANDMARKS_KEYFRAME_STORE_HPP
#define TEXTPLANE_LANDMARKS_KEYFRAME_STORE_HPP

#include <cstddef>
#include <iterator>
#include <map>
#include <memory>
#include <utility>

#include "textplane/landmarks/keyframe.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// Key frames in the order of their ids. An image is a view of the host's, or the store's own.
TEXTPLANE_DEFERRED
class BasicKeyframeStore {
 public:
  /// False, and nothing changed, for an id that is in use. `own`: what holds the image of `keyframe`, or null where the
  /// host does.
  bool add(int id, const TextKeyframe& keyframe, std::unique_ptr<Pyramid> own) {
    return all_.emplace(id, Entry{keyframe, std::move(own)}).second;
  }
  bool has(int id) const { return all_.count(id) != 0; }  ///< Whether it knows this key frame.
  /// Whether it still has its image.
  bool has_image(int id) const {
    const auto at = all_.find(id);
    return at != all_.end() && at->second.keyframe.pyramid.levels > 0;
  }
  /// Lets go of the images of the oldest ids until `most` are left, and of the poses too where needs(id) is false.
  template <class Needs>
  void forget_oldest(int most, Needs needs) {
    int images = 0;
    for (const auto& [id, entry] : all_) images += entry.keyframe.pyramid.levels > 0 ? 1 : 0;
    for (auto at = all_.begin(); at != all_.end();) {
      if (at->second.keyframe.pyramid.levels > 0 && images > most) {
        at->second.keyframe.pyramid = PyramidView{};
        at->second.own.reset();
        --images;
      }
      at = at->second.keyframe.pyramid.levels > 0 || needs(at->first) ? std::next(at) : all_.erase(at);
    }
  }
  void erase(int id) { all_.erase(id); }  ///< Lets go of all.
  /// The pose becomes f(id), world to camera, where that is finite.
  template <class PoseOf>
  void move(PoseOf f) {
    for (auto& [id, entry] : all_) {
      const SE3d T_c_w = f(id);
      if (all_finite(T_c_w)) entry.keyframe.T_w_c = T_c_w.inverse();
    }
  }
  /// The key frame; without an image, at the origin, for an unknown id.
  TextKeyframe text_keyframe(int id) const {
    const auto at = all_.find(id);
    return at == all_.end() ? TextKeyframe{} : at->second.keyframe;
  }
  std::size_t size() const noexcept { return all_.size(); }  ///< Key frames, those without an image included.
  /// Calls f(id, keyframe) in the order of the ids.
  template <class Visit>
  void for_each(Visit f) const {
    for (const auto& [id, entry] : all_) f(id, entry.keyframe);
  }
  /// Bytes of the images that it owns.
  std::size_t bytes() const {
    std::size_t sum = 0;
    for (const auto& [id, entry] : all_)
      if (entry.own)
        for (int l = 0; l < entry.own->levels(); ++l)
          sum += static_cast<std::size_t>(entry.own->level(l).width()) *
                 static_cast<std::size_t>(entry.own->level(l).height());
    return sum;
  }

 private:
  struct Entry {
    TextKeyframe keyframe;
    std::unique_ptr<Pyramid> own;
  };
  std::map<int, Entry> all_;
};
using KeyframeStore = BasicKeyframeStore<>;  ///< It is compiled only where it is used.

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_LANDMARKS_KEYFRAME_STORE_HPP
