// Two maps of one place in one file: what of each is in it, and what is refused.
#include <gtest/gtest.h>

#include "io/text_file.hpp"
#include "map_file/map_file_support.hpp"
#include "textslam/map/scale_map.hpp"
#include "textslam/map/text_views.hpp"
#include "textslam_map/map_queries.hpp"
#include "textslam_map/merge_maps.hpp"

namespace textslam {
namespace merge_test {

using namespace map_file_support;

// Map b is map a in another world and unit, of another session, with another point.
class Merge : public MapFileTest {
 protected:
  Merge() {
    for (TextObject& text : map.texts) text.covariance *= 0.1;
    other.map = map;
    other.record = record;
    other.record.sessions[0].started = "2026-02-01 09:00:00";
    other.record.sessions[0].sequence = "rooms/second";
    move(&other.map);
    other.map.texts[1].covariance *= 1e-2;
    other.map.texts[2].votes = {{"TAX1", 1.5}};
    b = folder.path("b.db");
    out = folder.path("out.db");
  }
  void move(Map* moved) const {
    scale_map(S.scale, moved);
    const Similarity turn{1, S.R, S.t};
    for (KeyFrame& keyframe : moved->keyframes) keyframe.T_w_c = turn * keyframe.T_w_c;
    for (MapPoint& point : moved->points) point.p_w = turn * point.p_w;
  }
  void save_both() const {
    save();
    save_map(b, other.map, other.record);
  }
  std::string merged() const { return merge_map_files(file, b, out); }
  LoadedMap result() const {
    EXPECT_EQ(problems_of(out), std::vector<std::string>());
    return load_map(out, parameters);
  }

  const Similarity S{0.4, textplane::so3_exp<double>(Vec3(0.2, -1.9, 0.5)), {3, 1, -2}};
  LoadedMap other;
  std::string b, out;
};

TEST_F(Merge, EachSignIsOnceAndAllElseTwice) {
  save_both();
  const std::string before_a = read_file(file), before_b = read_file(b);
  EXPECT_NE(merged().find("3 signs in common"), std::string::npos);
  EXPECT_EQ(read_file(file), before_a);
  EXPECT_EQ(read_file(b), before_b);
  const LoadedMap found = result();
  ASSERT_EQ(found.record.sessions.size(), 2u);
  EXPECT_EQ(found.record.sessions[1].id, 2);
  EXPECT_EQ(found.record.sessions[1].sequence, "rooms/second");
  EXPECT_EQ(found.map.keyframe_ids(), (std::vector<int>{0, 2, 3, 5}));
  EXPECT_EQ(found.record.sources.at(5).session, 2);
  EXPECT_EQ(found.record.sources.at(5).image, "images/2.png");
  for (const int id : {0, 2}) {
    EXPECT_LT((found.map.keyframe(id + 3).T_w_c.t - map.keyframe(id).T_w_c.t).norm(), 1e-6);
    EXPECT_LT(turn_between(found.map.keyframe(id + 3).T_w_c, map.keyframe(id).T_w_c), 1e-6);
  }
  EXPECT_EQ(found.map.keyframe(3).frame.image->level(0)(17, 23), map.keyframe(0).frame.image->level(0)(17, 23));
  const MapInfo info = read_map_info(out);
  EXPECT_EQ(info.texts, 3);
  EXPECT_EQ(info.points, 8);
  EXPECT_EQ(info.observations, 16);
  EXPECT_EQ(info.revision, 1);
  EXPECT_LT((found.map.point(5 + 1).p_w - map.point(1).p_w).norm(), 1e-6);
}

TEST_F(Merge, VotesAndObservationsAreAddedAndTheBetterPlaneStays) {
  save_both();
  ASSERT_NE(merged(), "");
  const LoadedMap found = result();
  const TextObject &kept = found.map.text(0), &taken = found.map.text(1), &misread = found.map.text(2);
  EXPECT_EQ(kept.votes.at("EXIT"), 6);
  EXPECT_NEAR(kept.votes.at("ExIT"), 1.4, 1e-12);
  EXPECT_EQ(misread.votes.at("TAXI"), 3);
  EXPECT_EQ(misread.votes.at("TAX1"), 1.5);
  EXPECT_EQ(kept.host, 0);
  EXPECT_EQ(kept.views, (std::vector<int>{2, 3, 5}));
  EXPECT_EQ(kept.detections, 8);
  EXPECT_EQ(kept.theta, map.texts[0].theta);
  EXPECT_EQ(taken.host, 3);
  EXPECT_EQ(taken.views, (std::vector<int>{0, 2, 5}));
  EXPECT_LT((taken.theta - map.texts[1].theta).norm(), 1e-6);
  EXPECT_LT((taken.covariance - 1e-2 * map.texts[1].covariance).norm(), 1e-4 * map.texts[1].covariance.norm());
  for (std::size_t i = 0; i < 3; ++i) {
    const auto corners = world_corners(found.map, found.map.texts[i]), right = world_corners(map, map.texts[i]);
    for (std::size_t k = 0; k < 4; ++k) EXPECT_LT((corners[k] - right[k]).norm(), 1e-6);
  }
}

TEST_F(Merge, RowsMoveInTheUnitOfTheMap) {
  record.camera.shutter.readout = other.record.camera.shutter.readout = 0.02;
  textplane::RowMotion motion;
  motion.velocity << 0.1, 0.2, 0.3, -0.1, -0.2, -0.3;
  motion.shutter = record.camera.shutter;
  textplane::RowMotion scaled = motion;
  scaled.velocity.head<3>() *= S.scale;
  map.set_rows(2, std::make_shared<const textplane::RowMotion>(motion));
  other.map.set_rows(2, std::make_shared<const textplane::RowMotion>(scaled));
  save_both();
  ASSERT_NE(merged(), "");
  EXPECT_LT((result().map.keyframe(5).frame.rows->velocity - motion.velocity).norm(), 1e-6);
}

// A map without metres takes those of the other.
TEST_F(Merge, MetresOfEitherAreKept) {
  other.record.scale_sigma = 0.01;
  save_both();
  ASSERT_NE(merged(), "");
  LoadedMap found = result();
  ASSERT_TRUE(found.record.scale_sigma.has_value());
  EXPECT_NEAR(*found.record.scale_sigma, 0.01, 1e-6);
  EXPECT_NEAR(found.map.keyframe(2).T_w_c.t.norm(), S.scale * map.keyframe(2).T_w_c.t.norm(), 1e-6);
  record.scale_sigma = 0.02;
  save_both();
  EXPECT_EQ(merged(), "") << "metres of one map are 0.4 of the other's";
}

TEST_F(Merge, NoCommonPlaceWritesNothing) {
  const char* const words[] = {"PRINTER", "LIBRARY", "CANTEEN"};
  for (std::size_t i = 0; i < 3; ++i) other.map.texts[i].votes = {{words[i], 2}};
  save_both();
  EXPECT_EQ(merged(), "");
  EXPECT_FALSE(std::filesystem::exists(out));
  out = file;
  const std::string before = read_file(file);
  EXPECT_EQ(merged(), "");
  EXPECT_EQ(read_file(file), before);
}

TEST_F(Merge, WhatCannotBeJoinedIsRefused) {
  other.record.sessions = record.sessions;
  save_both();
  EXPECT_THROW(merged(), InputError) << "the same session twice";
  EXPECT_THROW(merge_map_files(file, file, out), InputError);
  other.record.sessions[0].started = "2026-02-02 09:00:00";
  other.record.camera.raw = RadialTangential<double>{{262, 262, 159.5, 119.5}, -0.1, 0, 0, 0, 0};
  save_both();
  EXPECT_THROW(merged(), InputError) << "another camera";
  other.record.given_camera = record.camera;
  save_both();
  try {
    merged();
    ADD_FAILURE() << "another camera, from the same camera file";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("by itself"), std::string::npos) << error.what();
  }
  EXPECT_THROW(merge_map_files(file, folder.path("none.db"), out), InputError);
  EXPECT_FALSE(std::filesystem::exists(out));
}

TEST_F(Merge, TheOutputMayBeOneOfTheTwo) {
  save_both();
  out = file;
  ASSERT_NE(merged(), "");
  EXPECT_EQ(result().record.revision, 2);
  EXPECT_EQ(result().record.sessions.size(), 2u);
}

// The merged key frames have the ids of the first map, the file has images by those of the second.
TEST_F(Merge, ImagesGoWithTheirKeyFrames) {
  const Image<std::uint8_t> plain(map.width, map.height, 77);
  const std::shared_ptr<const Pyramid> of_b = std::make_shared<const Pyramid>(plain.view(), parameters.pyramid_levels);
  for (const int id : {0, 2}) other.map.keyframe(id).frame.image = of_b;
  save_both();
  out = b;
  ASSERT_NE(merged(), "");
  const LoadedMap found = result();
  for (const int id : {0, 2}) {
    EXPECT_EQ(found.map.keyframe(id).frame.image->level(0)(17, 23), map.keyframe(id).frame.image->level(0)(17, 23));
    EXPECT_EQ(found.map.keyframe(id + 3).frame.image->level(0)(17, 23), 77);
  }
}

}  // namespace merge_test
}  // namespace textslam
