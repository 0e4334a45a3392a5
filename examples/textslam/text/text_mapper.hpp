// TextMapper: the life of a text object (sections IV-B and V of the paper).
//
//   candidate  a detection in a key frame, or two in frames before it, on no known text and off the image border; its
//              corners are tracked
//   tentative  theta by the linear system [m']x t m^T theta = -[m']x R m once the corners have parallax, else by map
//              points round it; refined photometrically against its views
//   mapped     after n_min observations: takes part in tracking and adjustment; gets a better host
//   dropped    by the rules of textplane/landmarks/text_life.hpp
//
// How a text looks and which plane it has is the library's part, textplane/landmarks; this knows map and tracks.
#ifndef TEXTSLAM_TEXT_TEXT_MAPPER_HPP
#define TEXTSLAM_TEXT_TEXT_MAPPER_HPP

#include <vector>

#include "textslam/map/local_map.hpp"
#include "textslam/text/pending_texts.hpp"
#include "textslam/track/track.hpp"

namespace textslam {

class TextMapper {
 public:
  /// Texts outside `local` wait until they come into it, as they may have drifted; observe_again() takes all.
  TextMapper(Map& map, const LocalMap& local, const Parameters& parameters)
      : map_(map), local_(local), parameters_(parameters), pending_(parameters) {}

  /// Counts the detections of a tracked frame for the objects they fall on, and votes for their words. Remembers the
  /// others.
  void associate(const Frame& frame, const SE3d& T_c_w, const std::vector<Track>& tracks);
  /// Does a text that waits to be mapped, and is in view, have parallax since key frame `last`?
  bool has_parallax(const SE3d& T_c_w, const std::vector<Track>& tracks, int last) const;
  /// Quads of a frame's detections, and of those remembered of the frames before it, that would become new objects:
  /// not on a known text, not leaving the image.
  std::vector<Detection> new_detections(const Frame& frame, const SE3d& T_c_w, const std::vector<Track>& tracks) const;
  /// New candidates hosted by key frame `id`.
  void add_candidates(int id, const std::vector<Detection>& detections);
  /// After key frame `id` was added: planes for candidates, observations, refinement, promotion, culling.
  /// Mode loose: by loose_planes.hpp instead.
  void update(int id, const std::vector<Track>& tracks);
  /// After the planes and poses were adjusted: which key frames show the mapped texts, by what is known now.
  void observe_again();

 private:
  bool meets(const std::vector<Detection>& detections, const Quad<double>& quad) const;
  std::vector<Detection> unknown(const std::vector<Detection>& detections, const SE3d& T_c_w,
                                 const std::vector<Track>& tracks) const;
  bool locate(const TextObject& text, const SE3d& T_c_w, const std::vector<Track>& tracks, Quad<double>* quad) const;
  bool is_whole(const TextObject& text, const Quad<double>& quad, const SE3d& T_c_w) const;
  struct Corners {
    std::vector<Vec3> host, target;
  };
  Corners corners(const TextObject& text, int keyframe, const std::vector<Track>& tracks) const;
  SE3d middle_row(int id, const std::vector<Vec3>& rays) const;
  bool find_plane(TextObject& text, int id, const std::vector<Track>& tracks);
  bool plane_by_points(TextObject& text) const;
  void observe(TextObject& text, int keyframe, double min_share);
  void observe_until(TextObject& text, int id);

  Map& map_;
  const LocalMap& local_;
  const Parameters& parameters_;
  PendingTexts pending_;
};

}  // namespace textslam

#endif  // TEXTSLAM_TEXT_TEXT_MAPPER_HPP
