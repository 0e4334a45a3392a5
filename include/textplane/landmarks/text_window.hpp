// The texts of a TextMap in a Window, beside the host's frames and points.
//
//   Window window = ...;                                        // the host's key frames, points, gauge
//   WindowTexts texts(map, [&](int id) { return index_of(id); }, options, window);
//   solve_window(window, options, workspace);
//   texts.write_back(window);                                   // the planes; then map.move() for the poses
#ifndef TEXTPLANE_LANDMARKS_TEXT_WINDOW_HPP
#define TEXTPLANE_LANDMARKS_TEXT_WINDOW_HPP

#include <cstddef>
#include <map>
#include <utility>
#include <vector>

#include "textplane/landmarks/text_terms.hpp"
#include "textplane/solver/window_problem.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// See the head of this file.
TEXTPLANE_DEFERRED
class BasicWindowTexts {
 public:
  /// Adds to `window` the texts of `map` that its free frames see, and their observations. frame_of(id): the index of a
  /// key frame in window.frames, or -1 for one that it has not. Such hosts, and some of such views, are added as fixed
  /// frames at the end, so that the texts' planes stay what all views say. Frames that texts see need images: those
  /// without get the map's. The map must not change until the window is solved.
  template <class FrameOf>
  BasicWindowTexts(BasicTextMap<>& map, FrameOf frame_of, const WindowOptions& options, Window& window) : map_(map) {
    const auto moves = [&](int id) {
      const int frame = frame_of(id);
      return frame >= 0 && !window.frames[static_cast<std::size_t>(frame)].fixed;
    };
    const auto index = [&](int id) {
      int frame = frame_of(id);
      const TextKeyframe keyframe = map_.keyframes().text_keyframe(id);
      if (frame < 0) {
        const auto [at, is_new] = added_.try_emplace(id, static_cast<int>(window.frames.size()));
        if (is_new) window.frames.push_back({keyframe.T_w_c, true, keyframe.pyramid});
        frame = at->second;
      }
      PyramidView& image = window.frames[static_cast<std::size_t>(frame)].image;
      if (image.levels < 1) image = keyframe.pyramid;
      return frame;
    };
    const TextTerms all = text_terms(map, moves, StillViews::as_terms);
    auto term = all.terms.begin();
    first_ = window.texts.size();
    for (const TextPrior& prior : all.priors) {
      const int text = static_cast<int>(window.texts.size());
      ids_.push_back(prior.text->id);
      window.texts.push_back({index(prior.text->host), prior.text->theta, &prior.text->patch});
      for (; term != all.terms.end() && term->text == prior.text; ++term) {
        const double ratio = options.sigma_photo / term->sigma_photo;
        window.text_observations.push_back({text, index(term->target), ratio * ratio, term->scale_shift});
      }
    }
  }

  int texts() const noexcept { return static_cast<int>(ids_.size()); }  ///< Texts that the window got.

  /// The planes found become the map's.
  void write_back(const Window& window) {
    for (std::size_t i = 0; i < ids_.size(); ++i) map_.set_plane(ids_[i], window.texts[first_ + i].theta);
  }

 private:
  BasicTextMap<>& map_;
  std::size_t first_ = 0;  // its first text in the window
  std::vector<int> ids_;
  std::map<int, int> added_;  // frames that it added, by key frame
};
using WindowTexts = BasicWindowTexts<>;  ///< It is compiled only where it is used.

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_LANDMARKS_TEXT_WINDOW_HPP
