// Initialiser: watches corners from a reference frame until two views give a map that can be trusted.
#ifndef TEXTSLAM_INITIALISER_HPP
#define TEXTSLAM_INITIALISER_HPP

#include <vector>

#include "textslam/map.hpp"
#include "textslam/parameters.hpp"

namespace textslam {

class Initialiser {
 public:
  explicit Initialiser(const Parameters& parameters) : parameters_(parameters) {}

  /// Takes the next frame. True when `map` now holds two key frames (the reference and this frame) and their points, and
  /// `tracks` the corners in this frame. The map's median depth is 1.
  bool add(const Frame& frame, Map& map, std::vector<Track>* tracks);
  /// Of a frame added before: they matter if it is the reference.
  void add_detections(int frame, std::vector<Detection> detections);
  /// The next frame begins anew.
  void forget() { tracks_.clear(); }

 private:
  void restart(const Frame& frame);
  bool build(const Frame& frame, Map& map, std::vector<Track>* tracks);

  const Parameters& parameters_;
  Frame reference_, last_;
  std::vector<Track> tracks_;  // observations[0] is the corner in the reference frame
  int frames_ = 0;             // since the reference
  int ambiguous_ = 0;
};

}  // namespace textslam

#endif  // TEXTSLAM_INITIALISER_HPP
