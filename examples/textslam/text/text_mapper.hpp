// TextMapper: the life of a text object (sections IV-B and V of the paper).
//
// Detection in a key frame -> candidate (refused where it meets a known text or the image border) -> its corners are tracked;
// once they have parallax, theta by the linear system [m']x t m^T theta = -[m']x R m -> photometric refinement against the
// key frames that see it (where corners are lost before that, theta by the map points round it) -> tentative -> after n_min
// observations mapped: it takes part in tracking and adjustment, hosted anew where a key frame shows it much better
// (text_hosting.hpp) -> dropped when the images stop agreeing with it.
#ifndef TEXTSLAM_TEXT_TEXT_MAPPER_HPP
#define TEXTSLAM_TEXT_TEXT_MAPPER_HPP

#include <vector>

#include "textslam/common/parameters.hpp"
#include "textslam/map/local_map.hpp"
#include "textslam/map/map.hpp"

namespace textslam {

class TextMapper {
 public:
  /// Texts outside `local` are left alone until they come into it, all but observe_again(): where they seem to be says little.
  TextMapper(Map& map, const LocalMap& local, const Parameters& parameters)
      : map_(map), local_(local), parameters_(parameters) {}

  /// Counts the detections of a tracked frame for the objects they fall on, and votes for their words.
  void associate(const Frame& frame, const SE3d& T_c_w, const std::vector<Track>& tracks);
  /// Quads of a frame's detections that would become new objects: not on a known text, not leaving the image.
  std::vector<Detection> new_detections(const Frame& frame, const SE3d& T_c_w, const std::vector<Track>& tracks) const;
  /// New candidates hosted by key frame `id`.
  void add_candidates(int id, const std::vector<Detection>& detections);
  /// After key frame `id` was added: planes for candidates, observations, refinement, promotion, culling.
  /// Mode loose: by loose_planes.hpp instead.
  void update(int id, const std::vector<Track>& tracks);
  /// After the planes and poses were adjusted: which key frames show the mapped texts, by what is known now.
  void observe_again();

 private:
  bool locate(const TextObject& text, const SE3d& T_c_w, const std::vector<Track>& tracks, Quad<double>* quad) const;
  struct Corners {
    std::vector<Vec3> host, target;
  };
  Corners corners(const TextObject& text, int keyframe, const std::vector<Track>& tracks) const;
  bool find_plane(TextObject& text, int id, const std::vector<Track>& tracks);
  bool surface_plane(TextObject& text, int id);
  bool initial_plane(const TextObject& text, int keyframe, const std::vector<Track>& tracks, Vec3* theta) const;
  void observe(TextObject& text, int keyframe, double min_share);
  void observe_until(TextObject& text, int id);

  Map& map_;
  const LocalMap& local_;
  const Parameters& parameters_;
};

}  // namespace textslam

#endif  // TEXTSLAM_TEXT_TEXT_MAPPER_HPP
