// Key frames without a map, for the tests of texts.
#ifndef TESTS_LANDMARKS_FRAMES_SUPPORT_HPP
#define TESTS_LANDMARKS_FRAMES_SUPPORT_HPP

#include <memory>
#include <vector>

#include "textplane/geometry/plane.hpp"
#include "textplane/landmarks/keyframe.hpp"
#include "textplane/landmarks/text_object.hpp"

namespace landmarks_test {

using namespace textplane;
using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;

constexpr double kDegree = M_PI / 180;

// A keeper for KeyframeLookup.
struct Frames {
  struct Frame {
    SE3d T_w_c;
    std::shared_ptr<const Pyramid> image = nullptr;
  };

  Pinhole<double> camera;
  std::vector<Frame> all;

  Frame& operator[](int id) { return all[static_cast<std::size_t>(id)]; }
  const Frame& operator[](int id) const { return all[static_cast<std::size_t>(id)]; }
  TextKeyframe text_keyframe(int id) const {
    TextKeyframe keyframe;
    if ((*this)[id].image) keyframe.pyramid = (*this)[id].image->view();
    keyframe.camera = camera;
    keyframe.T_w_c = (*this)[id].T_w_c;
    return keyframe;
  }
  // Motion of points of one to another.
  SE3d between(int to, int from) const { return text_keyframe(to).from(text_keyframe(from)); }
};

inline double degrees_apart(const Vec3& a, const Vec3& b) { return std::atan2(a.cross(b).norm(), a.dot(b)) / kDegree; }

}  // namespace landmarks_test

#endif  // TESTS_LANDMARKS_FRAMES_SUPPORT_HPP
