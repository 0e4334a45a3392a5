// What prune takes away, and that it leaves a whole map whatever ends it.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <random>
#include <thread>

#include "io/text_file.hpp"
#include "map_file/map_file_support.hpp"
#include "textplane/landmarks/text_view.hpp"
#include "textslam/map_file/schema.hpp"
#include "textslam_map/map_queries.hpp"
#include "textslam_map/prune_map.hpp"

namespace textslam {
namespace prune_test {

using namespace map_file_support;

constexpr int kKills = 120;

// Two sessions: key frames 0 and 2 of the first, 3 and 4 of the second.
class Prune : public MapFileTest {
 protected:
  Prune() {
    record.sessions.push_back(record.sessions[0]);
    record.sessions[1].id = 2;
    for (int id = 3; id <= 4; ++id) {
      const SE3d T_c_w = moved({0.05 * id, 0, 0}, {0, 0.02 * id, 0});
      map.keyframes.push_back({frame_at(T_c_w), T_c_w.inverse(), {}});
      map.keyframes.back().frame.timestamp = id;
      record.sources[id] = {2, "second/" + std::to_string(id) + ".png"};
      for (const int point : {1, 2}) add_observation(map, point, id, {90.0 + point, 40.0 + id});
    }
    // Point 5 is the second session's; point 6 is seen once in each.
    for (const auto& seen : {std::pair<int, int>{3, 4}, {4, 2}}) {
      map.points.push_back({{0, 0.1, 3}});
      const int point = static_cast<int>(map.points.size()) - 1;
      add_observation(map, point, seen.first, {60, 70});
      add_observation(map, point, seen.second, {61, 71});
    }
    // Text 0 is seen in both; 1 in the first alone; 2 is hosted and seen in the second alone.
    map.texts[0].views = {2, 3};
    map.texts[2].host = 4;
    map.texts[2].views = {3};
  }

  Pruned prune(const PruneRules& rules) {
    save();
    const Pruned would = prune_map(file, rules, true), did = prune_map(file, rules, false);
    EXPECT_EQ(pruned_text(would, false), pruned_text(did, false)) << "a dry run says what will go";
    EXPECT_EQ(problems_of(file), std::vector<std::string>());
    return did;
  }
  std::vector<int> texts() const {
    std::vector<int> ids;
    for (const TextObject& text : load().map.texts)
      if (text.state == TextState::mapped) ids.push_back(text.id);
    return ids;
  }
  std::vector<int> seen_by(const Map& of, int point) const {
    std::vector<int> ids;
    for (const PointObservation& o : of.point(point).observations) ids.push_back(o.keyframe);
    return ids;
  }
};

TEST_F(Prune, TextsThatFewObserveGo) {
  PruneRules rules;
  rules.min_observations = 3;
  const Pruned pruned = prune(rules);
  EXPECT_EQ(pruned.texts, 2);
  EXPECT_EQ(pruned.keyframes + pruned.images + pruned.points + pruned.sessions, 0);
  EXPECT_GT(pruned.bytes, 0);
  EXPECT_EQ(texts(), (std::vector<int>{0}));
  Database database = open_map(file);
  for (const char* table : {"text_views", "votes", "patches", "words"})
    EXPECT_EQ(database.integer(std::string("select count(*) from ") + table + " where text <> 0"), 0) << table;
  EXPECT_EQ(database.integer("select count(*) from text_boxes"), 1);
}

TEST_F(Prune, TheBytesAreThoseOfTheFile) {
  save();
  const auto before = std::filesystem::file_size(file);
  PruneRules rules;
  rules.session = 2;
  const Pruned pruned = prune_map(file, rules, false);
  EXPECT_EQ(pruned.bytes, static_cast<std::int64_t>(before - std::filesystem::file_size(file)));
  EXPECT_GT(pruned.bytes, 5000) << "two images";
}

TEST_F(Prune, TextsOfUncertainNormalsGo) {
  map.texts[1].covariance *= 100;
  const double sigma = textplane::normal_sigma(map.texts[1]) / kDegree,
               others = textplane::normal_sigma(map.texts[0]) / kDegree;
  PruneRules rules;
  rules.max_sigma = 1.001 * sigma;
  EXPECT_EQ(prune(rules).texts, 0);
  rules.max_sigma = 0.999 * sigma;
  EXPECT_EQ(prune(rules).texts, 1);
  EXPECT_EQ(texts(), (std::vector<int>{0, 2}));
  rules.max_sigma = 0.1 * others;
  EXPECT_EQ(prune(rules).texts, 3);
}

TEST_F(Prune, ASessionGoesWithWhatIsItsAlone) {
  PruneRules rules;
  rules.session = 2;
  const Pruned pruned = prune(rules);
  EXPECT_EQ(pruned.keyframes, 2);
  EXPECT_EQ(pruned.images, 2);
  EXPECT_EQ(pruned.texts, 1);
  EXPECT_EQ(pruned.points, 2) << "its own, and one that a single key frame sees now";
  EXPECT_EQ(pruned.sessions, 1);
  const LoadedMap loaded = load();
  EXPECT_EQ(loaded.map.keyframe_ids(), (std::vector<int>{0, 2}));
  EXPECT_EQ(texts(), (std::vector<int>{0, 1}));
  EXPECT_EQ(loaded.map.texts[0].views, (std::vector<int>{2}));
  EXPECT_EQ(seen_by(loaded.map, 1), (std::vector<int>{0, 2}));
  EXPECT_EQ(loaded.record.revision, 2) << "a session that began before cannot be saved over it";
}

// Key frame 2 goes, 0 stays; what the second session needs of the first stays too.
TEST_F(Prune, WhatOthersNeedStays) {
  map.texts[0].host = 2;
  map.texts[0].views = {0, 3};
  map.texts[1].host = 0;
  map.texts[1].views = {};
  PruneRules rules;
  rules.session = 1;
  const Pruned pruned = prune(rules);
  EXPECT_EQ(pruned.keyframes, 0) << "the first, and the host of a text of the other session";
  EXPECT_EQ(pruned.texts, 1);
  EXPECT_EQ(pruned.sessions, 0);
  EXPECT_EQ(texts(), (std::vector<int>{0, 2}));
}

TEST_F(Prune, AnotherObservationIsThePointsHostThen) {
  for (TextObject& text : map.texts) text.host = text.id == 2 ? 4 : 0;
  map.texts[1].views = {3};
  map.points.push_back({{0.3, 0.1, 3}});
  for (const int id : {2, 3, 4}) add_observation(map, 7, id, {10.0 * id, 7});
  PruneRules rules;
  rules.session = 1;
  const Pruned pruned = prune(rules);
  EXPECT_EQ(pruned.keyframes, 1);
  const LoadedMap loaded = load();
  EXPECT_EQ(loaded.map.keyframe_ids(), (std::vector<int>{0, 3, 4}));
  EXPECT_EQ(seen_by(loaded.map, 7), (std::vector<int>{3, 4}));
  EXPECT_EQ(seen_by(loaded.map, 1), (std::vector<int>{0, 3, 4}));
  EXPECT_EQ(loaded.map.point(7).observations[0].px, Vec2(30, 7));
  Database database = open_map(file);
  EXPECT_EQ(database.integer("select keyframe from observations where point = 7 and number = 0"), 3);
  EXPECT_EQ(database.integer("select count(*) from observations o where number >= (select count(*) from observations p "
                             "where p.point = o.point)"),
            0);
}

TEST_F(Prune, RulesCountWhatTheSessionLeaves) {
  PruneRules rules;
  rules.session = 2;
  rules.min_observations = 3;
  EXPECT_EQ(prune(rules).texts, 3) << "the second session was the third observer of text 0";
}

TEST_F(Prune, ADryRunChangesNoByte) {
  save();
  const std::string before = read_file(file);
  PruneRules rules;
  rules.session = 2;
  rules.min_observations = 9;
  EXPECT_EQ(prune_map(file, rules, true).texts, 3);
  EXPECT_EQ(read_file(file), before);
  EXPECT_FALSE(std::filesystem::exists(file + "-journal"));
  rules = {};
  rules.min_observations = 1;
  EXPECT_EQ(prune_map(file, rules, false).texts, 0);
  EXPECT_EQ(read_file(file), before) << "nothing to take away";
}

TEST_F(Prune, WhatCannotBeIsRefused) {
  PruneRules rules;
  rules.session = 7;
  EXPECT_THROW(prune_map(file, rules, false), InputError);
  EXPECT_FALSE(std::filesystem::exists(file));
  save();
  const std::string before = read_file(file);
  EXPECT_THROW(prune_map(file, rules, false), InputError);
  EXPECT_THROW(prune_map(file, rules, true), InputError);
  for (auto& [id, source] : record.sources) source.session = 2;
  save();
  rules.session = 2;
  EXPECT_THROW(prune_map(file, rules, false), InputError) << "the whole map";
  EXPECT_EQ(load().map.keyframe_ids().size(), 4u);
}

TEST_F(Prune, AKillLeavesTheOldMapOrTheNewOne) {
  PruneRules rules;
  rules.session = 2;
  save();
  const std::string whole = read_file(file);
  const auto begin = std::chrono::steady_clock::now();
  prune_map(file, rules, false);
  const auto once = std::chrono::duration_cast<std::chrono::microseconds>(std::chrono::steady_clock::now() - begin);
  std::mt19937 random(5);
  int left_over = 0, kept = 0, pruned = 0;
  for (int i = 0; i < kKills; ++i) {
    std::filesystem::remove(file + "-journal");
    folder.write("map.db", whole);
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      prune_map(file, rules, false);
      _exit(0);
    }
    std::this_thread::sleep_for(once * (random() % 1500) / 1000);
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    left_over += std::filesystem::exists(file + "-journal") ? 1 : 0;
    ASSERT_EQ(problems_of(file), std::vector<std::string>());
    const LoadedMap found = load();
    const std::size_t keyframes = found.map.keyframe_ids().size();
    ASSERT_EQ(keyframes, found.record.revision == 1 ? 4u : 2u);
    ASSERT_EQ(texts().size(), found.record.revision == 1 ? 3u : 2u);
    ++(found.record.revision == 1 ? kept : pruned);
  }
  EXPECT_GT(kept, 0);
  EXPECT_GT(pruned, 0);
  EXPECT_GT(left_over, 0) << "no kill met it at work";
}

}  // namespace prune_test
}  // namespace textslam
