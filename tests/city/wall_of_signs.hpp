// A long wall with signs, and cameras in front of it: small maps whose answers are known.
#ifndef TEXTPLANE_TESTS_CITY_WALL_OF_SIGNS_HPP
#define TEXTPLANE_TESTS_CITY_WALL_OF_SIGNS_HPP

#include <string>
#include <vector>

#include "city/city_measure.hpp"
#include "city/city_words.hpp"
#include "sign_index/place_search.hpp"

namespace textslam {
namespace city_test {

/// The wall is the plane y = 0, seen from y < 0; x to the right, z up.
inline MappedSign sign_at(double x, double z, const std::string& word, double width = 1.4, double height = 0.3) {
  return {static_cast<std::int64_t>(1000 + 10 * x),
          word,
          {Vec3(x - width / 2, 0, z + height / 2), Vec3(x + width / 2, 0, z + height / 2),
           Vec3(x + width / 2, 0, z - height / 2), Vec3(x - width / 2, 0, z - height / 2)}};
}

/// A camera at (x, -distance, 1.6) that looks at the wall, turned to the left by `turn`.
inline SE3d camera_at(double x, double distance, double turn = 0.2) {
  SE3d T_w_c;
  T_w_c.R << 1, 0, 0, 0, 0, 1, 0, -1, 0;
  T_w_c.R = T_w_c.R * textplane::so3_exp<double>(Vec3(0, -turn, 0));
  T_w_c.t = Vec3(x, -distance, 1.6);
  return T_w_c;
}

/// Whole signs in view, with their words.
inline std::vector<Detection> seen_from(const std::vector<MappedSign>& signs, const SE3d& T_w_c) {
  const CameraModel camera = city_camera();
  const SE3d T_c_w = T_w_c.inverse();
  std::vector<Detection> found;
  for (const MappedSign& sign : signs) {
    Detection d;
    d.text = sign.word;
    bool inside = true;
    for (std::size_t k = 0; k < 4; ++k) {
      const Vec3 p = T_c_w * sign.corners[k];
      inside = inside && p.z() > 0.5;
      if (!inside) break;
      d.quad.corner[k] = camera.project(p);
      inside = d.quad.corner[k].minCoeff() > 1 && d.quad.corner[k][0] < 638 && d.quad.corner[k][1] < 478;
    }
    if (inside) found.push_back(d);
  }
  return found;
}

inline SignIndex index_of(const std::vector<MappedSign>& signs) {
  SignIndex index;
  EXPECT_EQ(SignIndex::build(signs, {}, &index), textplane::Status::ok);
  return index;
}

/// `count` names, 30 m from each other.
inline std::vector<MappedSign> lonely_signs(int count) {
  NameMaker names;
  Random random(5);
  std::vector<MappedSign> signs;
  for (int i = 0; i < count; ++i) signs.push_back(sign_at(30.0 * i, 2.2, names.make(random) + "SHOP"));
  return signs;
}

}  // namespace city_test
}  // namespace textslam

#endif  // TEXTPLANE_TESTS_CITY_WALL_OF_SIGNS_HPP
