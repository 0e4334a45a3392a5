// What is saved comes back, and anybody can ask for it in SQL.
#include <gtest/gtest.h>

#include <limits>

#include "io/text_file.hpp"
#include "map_file/map_file_support.hpp"
#include "textslam/map_file/database.hpp"
#include "textslam/map_file/schema.hpp"

namespace textslam {
namespace round_trip_test {

using namespace map_file_support;

constexpr double kLast = 1e-15;  // a turn goes through a quaternion

void expect_same(const textplane::PatchLevel& a, const textplane::PatchLevel& b) {
  EXPECT_EQ(a.x, b.x);
  EXPECT_EQ(a.y, b.y);
  EXPECT_EQ(a.intensity, b.intensity);
  EXPECT_EQ(a.gx, b.gx);
  EXPECT_EQ(a.gy, b.gy);
  EXPECT_EQ(a.taken_x, b.taken_x);
}

void expect_same(const TextObject& a, const TextObject& b) {
  EXPECT_EQ(a.state, b.state);
  EXPECT_EQ(a.host, b.host);
  EXPECT_EQ(a.theta, b.theta);
  EXPECT_EQ(a.covariance, b.covariance);
  EXPECT_EQ(a.views, b.views);
  EXPECT_EQ(a.votes, b.votes);
  EXPECT_EQ(a.detections, b.detections);
  EXPECT_EQ(a.shown, b.shown);
  EXPECT_EQ(a.zncc, b.zncc);
  EXPECT_EQ(a.variance_factor, b.variance_factor);
  EXPECT_EQ(a.patch.area, b.patch.area);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(a.patch.quad.corner[i], b.patch.quad.corner[i]);
  ASSERT_EQ(a.patch.levels.size(), b.patch.levels.size());
  for (std::size_t i = 0; i < a.patch.levels.size(); ++i) expect_same(a.patch.levels[i], b.patch.levels[i]);
}

TEST_F(MapFileTest, EverythingComesBack) {
  save();
  const LoadedMap loaded = load();
  ASSERT_EQ(loaded.map.keyframe_ids(), map.keyframe_ids());
  for (const int id : map.keyframe_ids()) {
    const KeyFrame &a = map.keyframe(id), &b = loaded.map.keyframe(id);
    EXPECT_EQ(a.T_w_c.t, b.T_w_c.t);
    EXPECT_LT((a.T_w_c.R - b.T_w_c.R).norm(), kLast);
    EXPECT_EQ(a.frame.timestamp, b.frame.timestamp);
    EXPECT_EQ(a.frame.noise, b.frame.noise);
    EXPECT_EQ(a.frame.smoothing, b.frame.smoothing);
    EXPECT_EQ(a.points, b.points);
    ASSERT_EQ(b.frame.detections.size(), 1u);
    EXPECT_EQ(a.frame.detections[0].text, b.frame.detections[0].text);
    EXPECT_EQ(a.frame.detections[0].quad.corner[2], b.frame.detections[0].quad.corner[2]);
    ASSERT_EQ(b.frame.image->levels(), at_size(parameters, 320, 240).pyramid_levels);
    for (int l = 0; l < b.frame.image->levels(); ++l)
      for (int y = 0; y < a.frame.image->level(l).height(); ++y)
        for (int x = 0; x < a.frame.image->level(l).width(); ++x)
          ASSERT_EQ(a.frame.image->level(l)(x, y), b.frame.image->level(l)(x, y));
  }
  ASSERT_EQ(loaded.map.points.size(), map.points.size());
  for (std::size_t i = 0; i < map.points.size(); ++i) {
    const MapPoint &a = map.points[i], &b = loaded.map.points[i];
    EXPECT_EQ(a.bad, b.bad);
    if (a.bad) continue;
    EXPECT_EQ(a.p_w, b.p_w);
    EXPECT_EQ(a.normal_w, b.normal_w);
    EXPECT_EQ(a.visible, b.visible);
    EXPECT_EQ(a.found, b.found);
    ASSERT_EQ(a.observations.size(), b.observations.size());
    for (std::size_t k = 0; k < a.observations.size(); ++k) {
      EXPECT_EQ(a.observations[k].keyframe, b.observations[k].keyframe);
      EXPECT_EQ(a.observations[k].px, b.observations[k].px);
    }
  }
  ASSERT_EQ(loaded.map.texts.size(), map.texts.size());
  for (std::size_t i = 0; i < map.texts.size(); ++i) expect_same(map.texts[i], loaded.map.texts[i]);
  ASSERT_EQ(loaded.record.sessions.size(), 1u);
  EXPECT_EQ(loaded.record.sessions[0].sequence, "rooms/first");
  EXPECT_EQ(loaded.record.sessions[0].tracked, 118);
  EXPECT_EQ(loaded.record.sources.at(2).image, "images/2.png");
  EXPECT_EQ(loaded.record.camera.width, 320);
  EXPECT_EQ(loaded.map.camera.pinhole.fx, 262);
  EXPECT_EQ(loaded.record.revision, 1);
}

// No frame of the session to come has the index of an earlier one.
TEST_F(MapFileTest, EarlierFramesHaveNegativeIndicesInTheirOrder) {
  save();
  const LoadedMap loaded = load();
  EXPECT_EQ(loaded.map.keyframe(0).frame.index, -4);
  EXPECT_EQ(loaded.map.keyframe(2).frame.index, -2);
  EXPECT_EQ(earlier_keyframe_id(-2, loaded.map.keyframes.size()), 2);
}

TEST_F(MapFileTest, ALensAndMovingRowsComeBack) {
  record.camera.raw = RadialTangential<double>{{262, 262, 159.5, 119.5}, -0.28, 0.07, 1e-3, -5e-4, 0};
  record.camera.shutter.readout = 0.02;
  map.shutter = record.camera.shutter;
  textplane::RowMotion motion;
  motion.velocity << 0.1, 0.2, 0.3, -0.1, -0.2, -1.0 / 3;
  motion.shutter = map.shutter;
  map.set_rows(2, std::make_shared<const textplane::RowMotion>(motion));
  save();
  const LoadedMap loaded = load();
  EXPECT_EQ(loaded.record.camera.raw.name(), record.camera.raw.name());
  ASSERT_NE(loaded.map.camera.lens, nullptr);
  EXPECT_EQ(loaded.record.camera.shutter.readout, 0.02);
  EXPECT_EQ(loaded.map.keyframe(0).frame.rows, nullptr);
  ASSERT_NE(loaded.map.keyframe(2).frame.rows, nullptr);
  EXPECT_EQ(loaded.map.keyframe(2).frame.rows->velocity, motion.velocity);
}

TEST_F(MapFileTest, ACameraThatIsBetterThanTheOneGivenComesBackWithIt) {
  save();
  EXPECT_FALSE(load().record.given_camera.has_value());
  record.given_camera = record.camera;
  record.camera.raw = RadialTangential<double>{{262, 262, 159.5, 119.5}, 0.01, 0, 0, 0, 0};
  save();
  const LoadedMap loaded = load();
  EXPECT_EQ(loaded.record.camera.raw.parameters(), record.camera.raw.parameters());
  EXPECT_NE(loaded.map.camera.lens, nullptr);
  ASSERT_TRUE(loaded.record.given_camera.has_value());
  EXPECT_EQ(loaded.record.given_camera->raw.name(), record.given_camera->raw.name());
  EXPECT_EQ(loaded.record.given_camera->raw.parameters(), record.given_camera->raw.parameters());
  EXPECT_EQ(loaded.record.given_camera->width, 320);
}

TEST_F(MapFileTest, SqlFindsWordsAndPlaces) {
  save();
  Database database = open_map(file);
  Statement texts(database, "select word, x, y, z from texts order by id");
  ASSERT_TRUE(texts.next());
  EXPECT_EQ(texts.text(0), "EXIT");
  EXPECT_NEAR(texts.number(1), -0.9, 1e-9);
  EXPECT_NEAR(texts.number(3), 3, 1e-9);
  Statement like(database, "select distinct text from words where words match 'OPE'");
  ASSERT_TRUE(like.next());
  EXPECT_EQ(like.integer(0, 0, 2), 1);
  EXPECT_FALSE(like.next());
  Statement near(database, "select id from text_boxes where min_x < 1.1 and max_x > 0.9");
  ASSERT_TRUE(near.next());
  EXPECT_EQ(near.integer(0, 0, 2), 2);
  EXPECT_FALSE(near.next());
  Statement size(database, "select width, height from texts where word = 'OPEN'");
  ASSERT_TRUE(size.next());
  EXPECT_NEAR(size.number(0), 2 * kHalfWidth, 1e-9);
  EXPECT_NEAR(size.number(1), 2 * kHalfHeight, 1e-9);
}

TEST_F(MapFileTest, ASecondSaveKeepsTheImagesAndCountsUp) {
  save();
  LoadedMap loaded = load();
  loaded.map.keyframe(2).T_w_c.t.x() = 0.5;
  loaded.map.texts[1].state = TextState::dropped;
  save_map(file, loaded.map, loaded.record);
  const LoadedMap again = load();
  EXPECT_EQ(again.record.revision, 2);
  EXPECT_EQ(again.map.keyframe(2).T_w_c.t.x(), 0.5);
  EXPECT_EQ(again.map.texts[1].state, TextState::dropped);
  EXPECT_EQ(again.map.texts[2].id, 2);
  EXPECT_EQ(again.map.keyframe(0).frame.image->level(0)(17, 23), map.keyframe(0).frame.image->level(0)(17, 23));
}

// Two programs go on in one map: the later save would throw away what the other one found.
TEST_F(MapFileTest, AMapThatChangedMeanwhileIsNotReplaced) {
  save();
  const LoadedMap one = load(), other = load();
  save_map(file, one.map, one.record);
  EXPECT_THROW(save_map(file, other.map, other.record), InputError);
  EXPECT_EQ(load().record.revision, 2);
}

// One of them is no reason to lose the others.
TEST_F(MapFileTest, WhatIsNotFiniteIsLeftOut) {
  map.points[1].p_w.x() = std::nan("");
  map.texts[0].theta.x() = std::nan("");
  map.texts[1].covariance(0, 0) = std::numeric_limits<double>::infinity();
  save();
  const LoadedMap loaded = load();
  EXPECT_TRUE(loaded.map.points[1].bad);
  EXPECT_FALSE(loaded.map.points[2].bad);
  EXPECT_EQ(loaded.map.texts[0].state, TextState::dropped);
  EXPECT_EQ(loaded.map.texts[1].state, TextState::mapped);
}

// Version 1 knew no metres. Reading leaves the file at its version; saving brings it up to date.
TEST_F(MapFileTest, AnOlderMapIsBroughtUpToDateWhenItIsSaved) {
  save();
  {
    Database database(file, Access::write);
    database.execute("drop table origins; alter table map drop column scale_sigma; pragma user_version = 1");
  }
  const std::string before = read_file(file);
  LoadedMap loaded = load();
  EXPECT_EQ(read_file(file), before);
  EXPECT_FALSE(loaded.record.scale_sigma.has_value());
  loaded.record.scale_sigma = 0.01;
  save_map(file, loaded.map, loaded.record);
  EXPECT_EQ(open_map(file).integer("pragma user_version"), schema_version());
  EXPECT_EQ(load().record.scale_sigma, 0.01);
}

TEST_F(MapFileTest, LoadingLeavesTheFileAsItIs) {
  save();
  const std::string before = read_file(file);
  load();
  EXPECT_EQ(read_file(file), before);
}

}  // namespace round_trip_test
}  // namespace textslam
