// COLMAP's models are read as they were written, as text and as binary; broken ones are refused in one line.
#include <gtest/gtest.h>

#include <filesystem>
#include <utility>

#include "io/image_file.hpp"
#include "io/text_file.hpp"
#include "map_file/map_file_support.hpp"
#include "textslam_map/export_map.hpp"
#include "textslam_map/import_colmap.hpp"

namespace textslam {
namespace colmap_read_test {

using namespace map_file_support;
namespace fs = std::filesystem;

class ColmapRead : public MapFileTest {
 protected:
  ColmapRead() : model(folder.path("model")) {
    save();
    written = colmap_scene(load(), model);
    export_colmap(load(), model);
  }
  void keep(const std::string& extension) const {
    for (const char* name : {"cameras", "images", "points3D"})
      fs::remove(model + "/" + name + (extension == ".txt" ? ".bin" : ".txt"));
  }
  void expect_refused(const std::string& said) const {
    try {
      camera_of(read_colmap_scene(model), model);
      ADD_FAILURE() << "read, but " << said;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(said), std::string::npos) << error.what();
    }
  }

  std::string model;
  ColmapScene written;
};

TEST_F(ColmapRead, IsWhatWasWritten) {
  for (const char* extension : {".bin", ".txt"}) {
    if (std::string(extension) == ".txt") keep(extension);
    const ColmapScene read = read_colmap_scene(model);
    EXPECT_EQ(read.camera.model, written.camera.model);
    EXPECT_EQ(read.camera.parameters, written.camera.parameters);
    const CameraModel camera = camera_of(read, model);
    EXPECT_EQ(camera.width, map.width);
    EXPECT_NEAR(camera.pinhole().cx, map.camera.pinhole.cx, 1e-12);
    ASSERT_EQ(read.images.size(), written.images.size());
    for (std::size_t i = 0; i < read.images.size(); ++i) {
      const ColmapScene::Image &a = read.images[i], &b = written.images[i];
      EXPECT_EQ(a.id, b.id);
      EXPECT_EQ(a.name, b.name);
      EXPECT_LT((a.T_c_w.R - b.T_c_w.R).norm() + (a.T_c_w.t - b.T_c_w.t).norm(), 1e-12);
      ASSERT_EQ(a.pixels.size(), b.pixels.size());
      for (std::size_t k = 0; k < a.pixels.size(); ++k) {
        EXPECT_EQ(a.pixels[k].px, b.pixels[k].px);
        EXPECT_EQ(a.pixels[k].point, b.pixels[k].point);
      }
    }
    ASSERT_EQ(read.points.size(), written.points.size());
    for (std::size_t i = 0; i < read.points.size(); ++i) {
      EXPECT_EQ(read.points[i].p, written.points[i].p);
      EXPECT_EQ(read.points[i].id, written.points[i].id);
      EXPECT_EQ(read.points[i].grey, written.points[i].grey);
      EXPECT_EQ(read.points[i].track, written.points[i].track);
    }
  }
}

TEST_F(ColmapRead, CutFilesAreRefused) {
  for (const char* name : {"/cameras.bin", "/images.bin", "/points3D.bin"}) {
    const std::string bytes = read_file(model + name);
    for (std::size_t end = 0; end < bytes.size(); end += 1 + bytes.size() / 60) {
      folder.write("model" + std::string(name), bytes.substr(0, end));
      expect_refused("it ends in the middle");
    }
    folder.write("model" + std::string(name), bytes);
  }
}

// Counts and numbers that no file holds.
TEST_F(ColmapRead, HugeNumbersAreRefused) {
  for (const char* name : {"/cameras.bin", "/images.bin", "/points3D.bin"}) {
    const std::string bytes = read_file(model + name);
    folder.write("model" + std::string(name), std::string(8, '\xff') + bytes.substr(8));
    expect_refused(std::string(name) == "/cameras.bin" ? "it has 18446744073709551615 cameras"
                                                       : "it ends in the middle");
    folder.write("model" + std::string(name), bytes);
  }
  const std::string cameras = read_file(model + "/cameras.bin");
  std::string changed = cameras;
  changed.replace(16, 8, std::string(8, '\x7f'));
  folder.write("model/cameras.bin", changed);
  expect_refused("the width should be a whole number");
  changed = cameras;
  changed[12] = 99;
  folder.write("model/cameras.bin", changed);
  expect_refused("a camera model that is not known");
  changed = cameras;
  changed[0] = 2;
  folder.write("model/cameras.bin", changed);
  expect_refused("it has 2 cameras");
}

// The images that a model names are there, and of its camera's size.
TEST_F(ColmapRead, ImagesAreThoseOfTheCamera) {
  const ColmapScene scene = read_colmap_scene(model);
  const CameraModel camera = camera_of(scene, model);
  DetectorOptions options;
  EXPECT_THROW(ImageDetections(options, camera, folder.path("none")), InputError);
  ImageDetections detections(options, camera, "");
  EXPECT_EQ(import_colmap(scene, camera, model + "/images", detections).map.keyframes.size(), scene.images.size());
  const std::string image = model + "/images/" + scene.images.back().name;
  save_png(image, Image<std::uint8_t>(8, 6, 100).view());
  try {
    import_colmap(scene, camera, model + "/images", detections);
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("this one is 8 x 6"), std::string::npos) << error.what();
  }
  fs::remove(image);
  EXPECT_THROW(import_colmap(scene, camera, model + "/images", detections), InputError);
}

TEST_F(ColmapRead, WhatIsNoModelIsRefused) {
  keep(".txt");
  const std::string cameras = read_file(model + "/cameras.txt"), images = read_file(model + "/images.txt");
  folder.write("model/cameras.txt", cameras + "2 PINHOLE 64 48 50 50 32 24\n");
  expect_refused("cameras.txt:3: a second camera");
  folder.write("model/cameras.txt", "# none\n");
  expect_refused("no camera");
  folder.write("model/cameras.txt", "1 PINHOLE 320 240 50 50 32\n");
  expect_refused("PINHOLE has 4 parameters, not 3");
  folder.write("model/cameras.txt", cameras);
  const std::pair<const char*, const char*> broken[] = {
      {"1 1 0 0 0 0 0 0 1\n\n", "images.txt:1: expected 'id qw"},
      {"1 0 0 0 0 0 0 0 1 a.png\n\n", "images.txt:1: a pose that is none"},
      {"1 1 0 0 0 0 0 0 1 a.png\n1 2\n", "images.txt:2: expected 'x y point'"},
      {"1 1 0 0 0 0 0 0 2 a.png\n\n", "images.txt:1: an image of camera 2"},
      {"1 1 0 0 0 0 0 0 1 a.png\n\n1 1 0 0 0 0 0 0 1 b.png\n\n", "two images 1"},
      {"1 1 0 0 0 0 0 0 1 a.png\n-5 2 -1\n", "a pixel outside of its image"},
      {"1 1 0 0 0 0 0 0 1 a.png\n5 2 777\n", "no point 777"},
  };
  for (const auto& [text, said] : broken) {
    folder.write("model/images.txt", text);
    expect_refused(said);
  }
  folder.write("model/images.txt", "\n# a comment\n" + images + "\n\n");
  EXPECT_EQ(read_colmap_scene(model).images.size(), written.images.size()) << "blank lines";
  folder.write("model/cameras.txt", "1 PINHOLE 1e300 48 50 50 32 24\n");
  expect_refused("the width should be a whole number");
  folder.write("model/cameras.txt", cameras);
  folder.write("model/points3D.txt", "1 0 0 nan 0 0 0 1\n");
  expect_refused("points3D.txt:1");
  fs::remove(model + "/images.txt");
  expect_refused("images.txt");
}

}  // namespace colmap_read_test
}  // namespace textslam
