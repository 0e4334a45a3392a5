// A map as other programs read it.
#include "textslam_map/export_map.hpp"

#include <gtest/gtest.h>

#include <sstream>

#include "io/image_file.hpp"
#include "io/text_file.hpp"
#include "map_file/map_file_support.hpp"

namespace textslam {
namespace export_map_test {

using namespace map_file_support;

std::vector<std::vector<std::string>> rows_of(const std::string& path) {
  std::vector<std::vector<std::string>> rows;
  std::istringstream text(read_file(path));
  for (std::string line; std::getline(text, line);) {
    if (!line.empty() && line[0] == '#') continue;
    std::istringstream words(line);
    rows.emplace_back();
    for (std::string word; words >> word;) rows.back().push_back(word);
  }
  return rows;
}

// Read as COLMAP reads it: every point projects to where its track says, and tracks and pixels refer to each other.
TEST_F(MapFileTest, ColmapsModelIsTheMap) {
  for (std::size_t i = 0; i < map.points.size(); ++i)
    for (PointObservation& o : map.points[i].observations)
      o.px = map.camera.project(map.keyframe(o.keyframe).T_w_c.inverse() * map.points[i].p_w);
  save();
  const std::string out = folder.path("colmap");
  export_colmap(load(), out);
  const CameraModel camera = read_camera(out + "/cameras.txt");
  EXPECT_EQ(camera.pinhole().fx, 262);
  const auto images = rows_of(out + "/images.txt"), points = rows_of(out + "/points3D.txt");
  ASSERT_EQ(images.size(), 4u);
  ASSERT_EQ(points.size(), 4u);
  for (const auto& point : points) {
    const Vec3 p(std::stod(point[1]), std::stod(point[2]), std::stod(point[3]));
    EXPECT_LT(std::stod(point[7]), 1e-9);
    ASSERT_EQ(point.size(), 8u + 4u) << "two images see it";
    for (std::size_t k = 8; k < point.size(); k += 2) {
      const std::size_t row = point[k] == images[0][0] ? 0 : 2;
      ASSERT_EQ(images[row][0], point[k]);
      std::vector<double> pose;
      for (std::size_t i = 1; i < 8; ++i) pose.push_back(std::stod(images[row][i]));
      const SE3d T_c_w{Eigen::Quaterniond(pose[0], pose[1], pose[2], pose[3]).toRotationMatrix(),
                       {pose[4], pose[5], pose[6]}};
      const std::size_t at = 3 * std::stoul(point[k + 1]);
      ASSERT_EQ(images[row + 1].at(at + 2), point[0]);
      const Vec2 px = camera.project(T_c_w * p);
      EXPECT_NEAR(px.x() + 0.5, std::stod(images[row + 1][at]), 1e-9);
      EXPECT_NEAR(px.y() + 0.5, std::stod(images[row + 1][at + 1]), 1e-9);
    }
  }
  const Image<std::uint8_t> image = load_grey(out + "/images/" + images[2][9]);
  EXPECT_EQ(image.view()(31, 77), map.keyframe(2).frame.image->level(0)(31, 77));
}

TEST_F(MapFileTest, PosesAndFacesAreExported) {
  record.sessions.push_back(record.sessions[0]);
  record.sessions[1].id = 2;
  record.sources[2].session = 2;
  save();
  const LoadedMap loaded = load();
  export_tum(loaded, 0, folder.path("last.txt"));
  const auto poses = read_tum(folder.path("last.txt"));
  ASSERT_EQ(poses.size(), 1u);
  EXPECT_NEAR((poses[0].T_w_c.t - map.keyframe(2).T_w_c.t).norm(), 0, 1e-9);
  EXPECT_THROW(export_tum(loaded, 3, folder.path("none.txt")), InputError);
  export_ply(loaded, folder.path("map.ply"));
  EXPECT_NE(read_file(folder.path("map.ply")).find("element face 3"), std::string::npos);
}

}  // namespace export_map_test
}  // namespace textslam
