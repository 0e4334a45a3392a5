// A save that is killed at any moment leaves the old map or the new one.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <random>
#include <thread>

#include "map_file/map_file_support.hpp"

namespace textslam {
namespace kill_test {

using namespace map_file_support;

constexpr int kKills = 200;

// A child saves one map after another, each with its revision in it, until it is killed.
TEST_F(MapFileTest, AKillLeavesTheOldMapOrTheNewOne) {
  save();
  std::mt19937 random(7);
  std::int64_t before = 1, saved = 0;
  int left_over = 0;
  for (int i = 0; i < kKills; ++i) {
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      LoadedMap loaded = load();
      for (;; ++loaded.record.revision) {
        const auto next = static_cast<double>(loaded.record.revision + 1);
        loaded.map.points[0].p_w.x() = next;
        loaded.map.keyframe(2).T_w_c.t.x() = next;
        save_map(file, loaded.map, loaded.record);
      }
    }
    std::this_thread::sleep_for(std::chrono::microseconds(10000 + random() % 40000));
    kill(child, SIGKILL);
    int status = 0;
    waitpid(child, &status, 0);
    ASSERT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL) << "it failed by itself";
    left_over += std::filesystem::exists(file + "-journal") ? 1 : 0;
    const LoadedMap found = load();
    ASSERT_GE(found.record.revision, before);
    if (found.record.revision > 1) {
      ASSERT_EQ(found.map.points[0].p_w.x(), static_cast<double>(found.record.revision));
      ASSERT_EQ(found.map.keyframe(2).T_w_c.t.x(), static_cast<double>(found.record.revision));
    }
    ASSERT_EQ(found.map.points.size(), map.points.size());
    saved += found.record.revision - before;
    before = found.record.revision;
  }
  EXPECT_GT(saved, 0) << "no child came to save anything";
  EXPECT_GT(left_over, 0) << "no kill met a save";
}

// Nothing is lost where the first save of a file is killed: it takes the next one.
TEST_F(MapFileTest, AKillOfTheFirstSaveLeavesNoMapOrAWholeOne) {
  std::mt19937 random(3);
  for (int i = 0; i < kKills / 4; ++i) {
    std::filesystem::remove(file);
    std::filesystem::remove(file + "-journal");
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      save();
      _exit(0);
    }
    std::this_thread::sleep_for(std::chrono::microseconds(random() % 30000));
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    if (std::filesystem::exists(file)) {
      const std::string said = refusal();
      EXPECT_TRUE(said.empty() || said == file + ": empty: it holds no map") << said;
    }
    save();
    EXPECT_EQ(refusal(), "");
  }
}

}  // namespace kill_test
}  // namespace textslam
