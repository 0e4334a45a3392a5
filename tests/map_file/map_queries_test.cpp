// What textslam-map tells of a map file.
#include "textslam_map/map_queries.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "io/text_file.hpp"
#include "map_file/map_file_support.hpp"
#include "textslam/map_file/database.hpp"
#include "textslam_map/text_query.hpp"

namespace textslam {
namespace map_queries_test {

using namespace map_file_support;

void change(const std::string& file, const std::string& sql) {
  Database database(file, Access::write);
  database.execute("pragma foreign_keys = off; " + sql);
}

TEST_F(MapFileTest, TextsAreAskedAsThoseOfAnOutputFolder) {
  save();
  const std::vector<IndexedText> texts = read_map_texts(file), found = query(texts, "open");
  ASSERT_EQ(texts.size(), 3u);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].id, 1);
  EXPECT_NEAR(found[0].score, 3 / 3.7, 1e-12);
  EXPECT_EQ(found[0].image, "images/0.png");
  EXPECT_EQ(found[0].timestamp, 0.1);
  EXPECT_LT((found[0].position - boards[1].T_w_b.t).norm(), 1e-9);
  EXPECT_LT((found[0].normal + boards[1].T_w_b.R.col(2)).norm(), 1e-9);
  EXPECT_EQ(query(texts, "exit").size(), 3u) << "a reading of each";
}

TEST_F(MapFileTest, InfoCountsWhatIsThere) {
  record.sessions.push_back(record.sessions[0]);
  record.sessions[1].id = 2;
  record.sources[2].session = 2;
  map.texts[2].host = 2;
  save();
  const MapInfo info = read_map_info(file);
  EXPECT_EQ(info.keyframes, 2);
  EXPECT_EQ(info.points, 4);
  EXPECT_EQ(info.observations, 8);
  EXPECT_EQ(info.texts, 3);
  EXPECT_EQ(info.keyframes_of, (std::vector<std::int64_t>{1, 1}));
  EXPECT_EQ(info.texts_of, (std::vector<std::int64_t>{2, 1}));
  EXPECT_NE(info_text(info).find("118 of 120 frames"), std::string::npos) << info_text(info);
  EXPECT_EQ(nlohmann::json::parse(info_json(info)).at("sessions").at(1).at("texts"), 1);
  EXPECT_TRUE(nlohmann::json::parse(info_json(info)).at("given_camera").is_null());
  EXPECT_EQ(info_text(info).find("given"), std::string::npos) << info_text(info);
}

TEST_F(MapFileTest, InfoTellsTheCameraGiven) {
  record.given_camera = record.camera;
  record.camera.raw = RadialTangential<double>{{262, 262, 159.5, 119.5}, 0.0125, 0, 0, 0, 0};
  save();
  const MapInfo info = read_map_info(file);
  const nlohmann::json data = nlohmann::json::parse(info_json(info));
  EXPECT_EQ(data.at("camera").at("parameters").at(4), 0.0125);
  EXPECT_EQ(data.at("given_camera").at("model"), record.given_camera->raw.name());
  EXPECT_NE(info_text(info).find("159.5 119.5 0.0125"), std::string::npos) << info_text(info);
  EXPECT_NE(info_text(info).find("given"), std::string::npos) << info_text(info);
}

TEST_F(MapFileTest, AWholeMapHasNoProblems) {
  save();
  EXPECT_EQ(problems_of(file), std::vector<std::string>());
}

TEST_F(MapFileTest, EachProblemIsFound) {
  const char* const changes[][2] = {
      {"update points set y = 9e999 where id = 1", "points.y: 1 not finite"},
      {"update texts set c_xx = 'much'", "texts.c_xx: 3 not finite"},
      {"delete from points where id = 2", "a row of observations refers to one of points that is gone"},
      {"delete from text_boxes where id = 1", "text_boxes: 1 texts are not in it"},
      {"delete from words where text = 1", "words: 2 readings are not in it"},
      {"update keyframes set qw = 3 where id = 2", "no unit quaternion"},
      {"delete from patches where text = 1", "has no patch"},
      {"drop table votes", "votes"},
  };
  for (const auto& [sql, problem] : changes) {
    std::filesystem::remove(file);
    save();
    change(file, sql);
    std::string all;
    for (const std::string& line : problems_of(file)) all += line + "\n";
    EXPECT_NE(all.find(problem), std::string::npos) << sql << ": " << all;
  }
}

TEST_F(MapFileTest, ADamagedPageIsAProblem) {
  constexpr std::size_t kPage = 4096;
  save();
  const std::string whole = read_file(file);
  for (std::size_t page = 2; page < 12; ++page) {
    std::string damaged = whole;
    damaged.replace(page * kPage, kPage, kPage, '\xff');
    std::ofstream(file, std::ios::binary) << damaged;
    EXPECT_FALSE(problems_of(file).empty()) << "page " << page;
  }
}

}  // namespace map_queries_test
}  // namespace textslam
