// What System gives back: of a frame, and of a mapped text.
#ifndef TEXTPLANE_PYTHON_RESULTS_HPP
#define TEXTPLANE_PYTHON_RESULTS_HPP

#include <array>
#include <string>
#include <vector>

#include "slam/slam.hpp"
#include "textslam/system/system.hpp"

namespace binding {

struct FrameResult {
  int index = -1;
  double timestamp = 0;
  textslam::FrameState state = textslam::FrameState::waiting;
  tp::SE3d T_w_c;
  textslam::FoundBy by = textslam::FoundBy::nothing;
  double position_sigma = 0;
  int map = -1, keyframe = -1, points = 0, texts = 0;
};

struct MappedText {
  int id = -1, observations = 0, host = -1;
  std::string word;
  std::array<Vec3, 4> corners{Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
  Vec3 normal = Vec3::Zero(), theta = Vec3::Zero();
  double zncc = 0;
};

FrameResult result_of(const textslam::FrameRecord& record, int index);
std::vector<MappedText> texts_of(const textslam::Map& map);
void bind_results(py::module_& m);

}  // namespace binding

#endif  // TEXTPLANE_PYTHON_RESULTS_HPP
