// What the tests of the programs share: running one as a user does, and looking at what it wrote.
#ifndef TESTS_PROGRAMS_TEXTSLAM_SUPPORT_HPP
#define TESTS_PROGRAMS_TEXTSLAM_SUPPORT_HPP

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <sys/wait.h>

#include "io/io_support.hpp"
#include "io/sequence.hpp"
#include "io/trajectory.hpp"
#include "renderer/render_sequence.hpp"

namespace textslam {

constexpr std::array<const char*, 10> kOutputs = {
    "trajectory.txt", "trajectory_live.txt", "keyframes.txt", "covariances.csv", "text_map.json",
    "text_map.ply",   "timing.json",         "metrics.json",  "text_index.json", "report.html"};

inline std::string quoted(const std::string& word) {
  std::string out = "'";
  for (const char c : word) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

inline std::string bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  EXPECT_TRUE(file.good()) << path;
  std::ostringstream out;
  out << file.rdbuf();
  return out.str();
}

/// The inside of the script element `id` of a report.
inline std::string report_block(const std::string& page, const std::string& id) {
  const std::string start = "<script type=\"application/json\" id=\"" + id + "\">", end = "</script>";
  const std::size_t from = page.find(start);
  EXPECT_NE(from, std::string::npos) << id;
  if (from == std::string::npos) return "";
  const std::size_t to = page.find(end, from);
  EXPECT_NE(to, std::string::npos) << id;
  return page.substr(from + start.size(), to - from - start.size());
}

/// What two equal runs have in common of an output file; empty: nothing need be the same.
inline std::string same_part(const std::string& folder, const std::string& name) {
  if (name == "timing.json") return "";  // milliseconds
  std::string bytes = bytes_of(folder + "/" + name);
  if (name != "report.html") return bytes;
  // The command line, which names the folders, and milliseconds.
  const std::string block = report_block(bytes, "run");
  return bytes.erase(bytes.find(block), block.size());
}

struct ProgramResult {
  int code = -1;  ///< exit code; -1 when it ended otherwise
  std::string out, err;
};

/// Runs a program with these words as arguments, its standard error not on a terminal.
inline ProgramResult run_program(const std::string& program, const std::vector<std::string>& arguments) {
  const TemporaryFolder streams;
  std::string command = quoted(program);
  for (const std::string& argument : arguments) command += " " + quoted(argument);
  command += " >" + quoted(streams.path("out")) + " 2>" + quoted(streams.path("err"));
  const int status = std::system(command.c_str());
  ProgramResult result;
  if (status != -1 && WIFEXITED(status)) result.code = WEXITSTATUS(status);
  result.out = bytes_of(streams.path("out"));
  result.err = bytes_of(streams.path("err"));
  return result;
}
inline ProgramResult textslam_program(const std::vector<std::string>& arguments) {
  return run_program(TEXTSLAM_PROGRAM, arguments);
}

/// It ended with this code and one line on standard error that starts with `name: ` and `place`, and says `part`.
inline void expect_refused(const ProgramResult& result, int code, const std::string& place, const std::string& part,
                           const std::string& name = "textslam") {
  const std::string start = name + ": " + place;
  EXPECT_EQ(result.code, code) << result.err;
  EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
  EXPECT_EQ(result.err.compare(0, start.size(), start), 0) << result.err << " should name " << place;
  EXPECT_NE(result.err.find(part), std::string::npos) << result.err << " should say " << part;
}

inline void expect_success(const ProgramResult& result) {
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(result.err, "");
}

/// The program ran to its end, and no frame could be tracked.
inline void expect_no_map(const ProgramResult& result) {
  expect_refused(result, 3, "", "could be tracked, so there is no map");
}

/// Every output file is there and whole, nothing else beside them but `more`.
inline void expect_all_outputs(const std::string& folder, const std::set<std::string>& more = {}) {
  for (const char* name : kOutputs) EXPECT_TRUE(std::filesystem::exists(folder + "/" + name)) << name;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    const bool known = std::find(kOutputs.begin(), kOutputs.end(), name) != kOutputs.end() || more.count(name) > 0;
    EXPECT_TRUE(known) << name;
    const std::string kind = entry.path().extension().string(), path = entry.path().string();
    EXPECT_TRUE(kind != ".json" || nlohmann::json::accept(bytes_of(path))) << name;
    EXPECT_NO_THROW(kind == ".txt" ? read_tum(path) : std::vector<StampedPose>()) << name;
  }
}

/// A rendered sequence in `folder`.
inline void render(const std::string& folder, const std::string& kind, int frames, int width, std::uint64_t seed = 1,
                   int walk = 0) {
  RenderOptions options;
  options.seed = seed;
  options.walk = walk;
  options.kind = kind;
  options.output = folder;
  options.frames = frames;
  options.width = width;
  options.height = width * 3 / 4;
  render_sequence(options);
}

inline std::vector<double> times_of(const std::vector<StampedPose>& poses) {
  std::vector<double> times;
  for (const StampedPose& pose : poses) times.push_back(pose.timestamp);
  return times;
}

}  // namespace textslam

#endif  // TESTS_PROGRAMS_TEXTSLAM_SUPPORT_HPP
