// A room, and the map of a first session in it, for tests of what comes after.
#ifndef TESTS_PROGRAMS_SESSIONS_SUPPORT_HPP
#define TESTS_PROGRAMS_SESSIONS_SUPPORT_HPP

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "io/evaluate.hpp"
#include "io/io_support.hpp"
#include "programs/textslam_support.hpp"
#include "textslam/run.hpp"

namespace textslam {

namespace fs = std::filesystem;

class Sessions : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TemporaryFolder;
    render("first", 1, 0, 110);
    render("second", 1, 1, 50);
    render("elsewhere", 7, 0, 24);
    RunOptions options = options_for("first", "out_first");
    options.save_map = path("map.db");
    ASSERT_EQ(run(options).error, "");
  }
  static void TearDownTestSuite() {
    delete folder_;
    folder_ = nullptr;
  }

  static std::string path(const std::string& name) { return folder_->path(name); }
  static void render(const std::string& name, std::uint64_t seed, int walk, int frames, int width = 320) {
    textslam::render(path(name), "room", frames, width, seed, walk);
  }
  static RunOptions options_for(const std::string& sequence, const std::string& output) {
    RunOptions options;
    options.sequence = path(sequence);
    options.output = path(output);
    options.report = false;
    return options;
  }
  // Errors of the poses in the map's world, aligned as the first session is.
  static std::vector<double> errors_of(const std::string& output, const std::string& sequence) {
    const auto truth = read_tum(path("first/groundtruth.txt"));
    const Similarity alignment =
        evaluate_trajectory(read_tum(path("out_first/trajectory.txt")), truth, truth.size()).alignment;
    const auto poses = read_tum(path(output + "/trajectory.txt")),
               right = read_tum(path(sequence + "/groundtruth.txt"));
    std::vector<double> errors;
    for (const PosePair& pair : associate(poses, right, 0.01))
      errors.push_back((alignment * poses[pair.estimate].T_w_c.t - right[pair.truth].T_w_c.t).norm());
    return errors;
  }
  static std::string copy_of_map(const std::string& name) {
    fs::copy_file(path("map.db"), path(name), fs::copy_options::overwrite_existing);
    return path(name);
  }

  inline static TemporaryFolder* folder_ = nullptr;
};

}  // namespace textslam

#endif  // TESTS_PROGRAMS_SESSIONS_SUPPORT_HPP
