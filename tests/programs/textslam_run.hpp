// What the tests of whole runs share: a rendered room, and the program's results on it.
#ifndef TESTS_PROGRAMS_TEXTSLAM_RUN_HPP
#define TESTS_PROGRAMS_TEXTSLAM_RUN_HPP

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "programs/textslam_support.hpp"

namespace textslam {

using Json = nlohmann::json;

constexpr int kFrames = 80;

inline Json json_of(const std::string& path) { return Json::parse(bytes_of(path)); }

/// A third of the room's loop, and the program's results on it, made once.
class TextslamRun : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TemporaryFolder;
    render(room(), "room", kFrames, 480);
    first_ = new ProgramResult(textslam_program({room(), "--output", output()}));
  }
  static void TearDownTestSuite() {
    delete first_;
    delete folder_;
  }

  static std::string room(const std::string& name = "") {
    return folder_->path(name.empty() ? "room" : "room/" + name);
  }
  static std::string output(const std::string& name = "") {
    return folder_->path(name.empty() ? "out" : "out/" + name);
  }
  static ProgramResult run(const std::string& sequence, const std::string& to, std::vector<std::string> more = {}) {
    more.insert(more.begin(), {sequence, "--output", folder_->path(to)});
    return textslam_program(more);
  }

  inline static TemporaryFolder* folder_ = nullptr;
  inline static ProgramResult* first_ = nullptr;
};

}  // namespace textslam

#endif  // TESTS_PROGRAMS_TEXTSLAM_RUN_HPP
