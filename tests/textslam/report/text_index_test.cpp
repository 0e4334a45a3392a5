// The texts of a map by their words: the best view of each, the file, and queries.
#include "textslam/report/text_index.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "io/io_support.hpp"
#include "textplane/geometry/plane.hpp"
#include "textslam_map/text_query.hpp"

namespace textslam {
namespace {

// A text 0.6 x 0.2 wide, 3 units before the first of three key frames: the second is nearer, the third so near that a
// part is outside its image.
Map map_of_one_text() {
  Map map;
  map.camera = {500, 500, 319.5, 239.5};
  map.width = 640;
  map.height = 480;
  map.keyframes.resize(3);
  for (int i = 0; i < 3; ++i) {
    KeyFrame& keyframe = map.keyframe(i);
    keyframe.frame.index = 10 * i;
    keyframe.frame.timestamp = 0.5 * i;
    keyframe.T_w_c.t = Vec3(0, 0, i == 0 ? 0 : i == 1 ? 1.5 : 2.6);
  }
  TextObject text;
  text.id = 0;
  text.state = TextState::mapped;
  text.host = 0;
  text.views = {1, 2};
  const Vec3 corners[4] = {{-0.3, -0.1, 3}, {0.3, -0.1, 3}, {0.3, 0.1, 3}, {-0.3, 0.1, 3}};
  text.patch.camera = map.camera.pinhole;
  for (std::size_t i = 0; i < 4; ++i) text.patch.quad.corner[i] = map.camera.project(corners[i]);
  text.theta = Vec3(0, 0, 1.0 / 3);
  text.votes = {{"EXIT", 1.5}, {"EX1T", 0.5}};
  map.texts.push_back(text);
  text.id = 1;
  text.state = TextState::tentative;
  map.texts.push_back(text);
  return map;
}

TEST(TextIndex, VotesWeighByTheirScores) {
  TextObject text;
  text.votes = {{"OFTEN", 0.3 + 0.3 + 0.3}, {"SURE", 0.95}};
  EXPECT_EQ(textplane::consensus(text.votes), "SURE");
}

TEST(TextIndex, TellsWhereATextIsAndWhatShowsItBest) {
  const auto texts = index_texts(map_of_one_text(), [](int index) { return "f" + std::to_string(index) + ".png"; });
  ASSERT_EQ(texts.size(), 1u) << "mapped texts alone";
  EXPECT_EQ(texts[0].text, "EXIT");
  EXPECT_NEAR(texts[0].score, 0.75, 1e-12);
  EXPECT_LT((texts[0].position - Vec3(0, 0, 3)).norm(), 1e-12);
  EXPECT_LT((texts[0].normal - Vec3(0, 0, -1)).norm(), 1e-12);
  EXPECT_EQ(texts[0].image, "f10.png") << "the nearer one, but not that which cuts it off";
  EXPECT_EQ(texts[0].timestamp, 0.5);
  EXPECT_LT((texts[0].quad.corner[2] - Vec2(319.5 + 100, 239.5 + 100.0 / 3)).norm(), 1e-9);
}

TEST(TextIndex, SurvivesTheFile) {
  const auto texts = index_texts(map_of_one_text(), [](int) { return std::string("a \"quoted\" name.png"); });
  const TemporaryFolder folder;
  const std::string path = folder.write("text_index.json", text_index_json(texts));
  EXPECT_EQ(text_index_json(read_text_index(path)), text_index_json(texts));
  expect_input_error([&] { read_text_index(folder.path("none.json")); }, folder.path("none.json"), 0, "");
  const std::string broken = folder.write("broken.json", "{\"texts\": [{\"id\": 1}]}");
  expect_input_error([&] { read_text_index(broken); }, broken, 0, "texts[0]");
  for (const char* id : {"1.5", "1e44", "3000000000", "-1e44"}) {
    const std::string numbered = folder.write("numbered.json", "{\"texts\": [{\"id\": " + std::string(id) + "}]}");
    expect_input_error([&] { read_text_index(numbered); }, numbered, 0, "texts[0]: a whole number expected");
  }
}

TEST(TextIndex, QueriesFindWordsAndReadings) {
  const auto text = [](int id, const std::string& word, double score, std::map<std::string, double> readings) {
    IndexedText out;
    out.id = id;
    out.text = word;
    out.score = score;
    out.readings = std::move(readings);
    return out;
  };
  const std::vector<IndexedText> texts = {text(0, "EXITS", 0.9, {{"EXITS", 2}}), text(1, "Exit", 0.6, {{"Exit", 2}}),
                                          text(2, "EX1T", 0.5, {{"EX1T", 2}, {"EXIT", 1}}), text(3, "exit", 0.8, {}),
                                          text(4, kUnreadText, 0, {})};
  std::vector<int> ids;
  for (const IndexedText& found : query(texts, "eXiT")) ids.push_back(found.id);
  EXPECT_EQ(ids, (std::vector<int>{3, 1, 0, 2}));
  ids.clear();
  for (const IndexedText& found : query(texts, "EXIST")) ids.push_back(found.id);
  EXPECT_EQ(ids, (std::vector<int>{1, 2})) << "one letter too many; in EXITS it is two";
  EXPECT_TRUE(query(texts, "door").empty());
  EXPECT_TRUE(query(texts, "").empty());
  EXPECT_TRUE(query(texts, "##").empty()) << "what nobody read is no word";
}

TEST(TextIndex, WordsThatBeginSoGoBeforeThoseThatHoldIt) {
  std::vector<IndexedText> texts;
  for (const char* word : {"ROOM", "EXIT MAIN", "Men", "M", "m"}) {
    IndexedText text;
    text.id = static_cast<int>(texts.size());
    text.text = word;
    text.score = 1 - 0.1 * text.id;
    texts.push_back(text);
  }
  std::vector<int> ids;
  for (const IndexedText& found : query(texts, "M")) ids.push_back(found.id);
  EXPECT_EQ(ids, (std::vector<int>{3, 4, 2, 1, 0}));
}

TEST(TextIndex, AnglesAsJson) {
  std::vector<IndexedText> texts(3);
  for (int i = 0; i < 3; ++i) {
    texts[static_cast<std::size_t>(i)].id = 7 + i;
    texts[static_cast<std::size_t>(i)].text = std::string(1, static_cast<char>('A' + i));
    texts[static_cast<std::size_t>(i)].normal =
        textplane::so3_exp<double>(Vec3(0, i * i * M_PI / 180, 0)) * Vec3(0, 0, -1);
  }
  const nlohmann::json json = nlohmann::json::parse(angles_json(texts));
  ASSERT_EQ(json.at("texts").size(), 3u);
  EXPECT_EQ(json.at("texts")[1].at("id"), 8);
  EXPECT_EQ(json.at("texts")[1].at("text"), "B");
  EXPECT_EQ(json.at("texts")[0].at("normal"), (std::vector<double>{0, 0, -1}));
  const double expected[3][3] = {{0, 1, 4}, {1, 0, 3}, {4, 3, 0}};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) EXPECT_NEAR(json.at("degrees")[i][j].get<double>(), expected[i][j], 1e-9);
  EXPECT_NEAR(json.at("largest").at("degrees").get<double>(), 4, 1e-9);
  EXPECT_EQ(json.at("largest").at("texts"), (std::vector<int>{7, 9}));
  texts.resize(1);
  EXPECT_TRUE(nlohmann::json::parse(angles_json(texts)).at("largest").is_null());
}

TEST(TextIndex, AnglesBetweenNormals) {
  IndexedText a, b;
  a.normal = Vec3(0, 0, -1);
  b.normal = textplane::so3_exp<double>(Vec3(0, 2.5 * M_PI / 180, 0)) * a.normal;
  EXPECT_NEAR(angle_between(a, b), 2.5, 1e-9);
  EXPECT_EQ(angle_between(a, a), 0);
  b.normal = -a.normal;
  EXPECT_NEAR(angle_between(a, b), 180, 1e-9);
}

}  // namespace
}  // namespace textslam
