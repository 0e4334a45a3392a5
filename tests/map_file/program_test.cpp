// textslam-map as it is called: exit codes, and one line on standard error.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdio>

#include "io/text_file.hpp"
#include "map_file/map_file_support.hpp"

namespace textslam {
namespace program_test {

using namespace map_file_support;

class MapProgram : public MapFileTest {
 protected:
  struct Result {
    int code;
    std::string said;  // both streams
  };
  static Result run(const std::string& arguments) { return run_after("", arguments); }
  // No file may become longer than 512 bytes.
  static Result run_on_full_disk(const std::string& arguments) {
    return run_after("trap '' XFSZ; ulimit -f 1; ", arguments);
  }
  static Result run_after(const std::string& before, const std::string& arguments) {
    std::FILE* const pipe = popen((before + "'" TEXTSLAM_MAP_PROGRAM "' " + arguments + " 2>&1").c_str(), "r");
    Result result{-1, ""};
    for (int c = 0; (c = std::fgetc(pipe)) != EOF;) result.said.push_back(static_cast<char>(c));
    const int status = pclose(pipe);
    if (WIFEXITED(status)) result.code = WEXITSTATUS(status);
    return result;
  }
  static void expect_refused(const Result& result, int code, const std::string& line) {
    EXPECT_EQ(result.code, code) << result.said;
    EXPECT_EQ(result.said.find("textslam-map: " + line), 0u) << result.said;
    EXPECT_EQ(std::count(result.said.begin(), result.said.end(), '\n'), 1) << result.said;
  }
};

TEST_F(MapProgram, GeoJson) {
  save();
  const std::string json = folder.path("map.geojson"), to = "export " + file + " --geojson " + json;
  expect_refused(run(to + " --origin -33.85,151.21 --north -10"), 2, file + ": its lengths are not metres");
  record.scale_sigma = 0.01;
  save();
  expect_refused(run(to), 2, "--geojson: give --origin");
  expect_refused(run(to + " --origin -33.85 --north 0"), 2, "--origin: should be LAT,LON");
  expect_refused(run(to + " --origin 1,2 --north nan"), 2, "--north");
  EXPECT_FALSE(std::filesystem::exists(json));
  const Result done = run(to + " --origin -33.85,151.21,20 --north -10");
  EXPECT_EQ(done.code, 0) << done.said;
  EXPECT_EQ(done.said, "");
  EXPECT_NE(read_file(json).find("\"FeatureCollection\""), std::string::npos);
}

TEST_F(MapProgram, Prune) {
  save();
  const std::string before = read_file(file);
  expect_refused(run("prune " + file), 2, "prune: give --min-observations, --max-sigma or --session");
  expect_refused(run("prune " + file + " --session 4"), 2, file + ": it has no session 4");
  expect_refused(run("prune " + file + " --session 1"), 2, file + ": session 1 is all that it holds");
  expect_refused(run("prune " + folder.path("no.db") + " --session 1"), 2, folder.path("no.db") + ": no such file");
  const Result dry = run("prune --dry-run --min-observations 3 " + file);
  EXPECT_EQ(dry.code, 0);
  EXPECT_EQ(dry.said.find("would go: 3 texts, 0 key frames"), 0u) << dry.said;
  EXPECT_EQ(read_file(file), before);
  const Result done = run("prune --min-observations 3 " + file);
  EXPECT_EQ(done.said, "gone:" + dry.said.substr(std::string("would go:").size()));
  EXPECT_EQ(run("check " + file).code, 0);
}

// Exit code 1: the input is fine, the disk is not.
TEST_F(MapProgram, AFullDiskIsOneLine) {
  save();
  const std::string before = read_file(file);
  expect_refused(run_on_full_disk("prune --max-sigma 0 " + file), 1, file + ": cannot write: ");
  EXPECT_EQ(run("check " + file).code, 0);
  EXPECT_EQ(read_file(file), before);
}

TEST_F(MapProgram, Merge) {
  save();
  record.sessions[0].started = "2026-02-02 09:00:00";
  const std::string a = file, b = folder.path("b.db"), out = folder.path("out.db");
  save_map(b, map, record);
  const Result done = run("merge " + a + " " + b + " --output " + out);
  EXPECT_EQ(done.code, 0) << done.said;
  EXPECT_EQ(done.said.find("3 signs in common"), 0u) << done.said;
  EXPECT_EQ(run("check " + out).code, 0);
  std::filesystem::remove(out);
  for (TextObject& text : map.texts) text.votes = {{"PRINTER", 1}};
  save_map(b, map, record);
  expect_refused(run("merge " + a + " " + b + " --output " + out), 1, a + " and " + b + ": no common place found");
  EXPECT_FALSE(std::filesystem::exists(out));
  expect_refused(run("merge " + a + " " + a + " --output " + out), 2, a + ": it holds the session of");
}

// Where the program was built without PostgreSQL it says that.
TEST_F(MapProgram, AServerThatIsNotThereIsOneLine) {
  save();
  const std::string before = read_file(file), none = folder.path("none.db");
  const Result push = run("push " + file + " 'host=/nowhere dbname=maps'"),
               pull = run("pull postgresql://127.0.0.1:1/maps " + none);
  expect_refused(push, 2, push.said.find("built without") == std::string::npos ? "server: connection" : "push: this");
  expect_refused(pull, 2, pull.said.find("built without") == std::string::npos ? "server: connection" : "pull: this");
  EXPECT_EQ(read_file(file), before);
  EXPECT_FALSE(std::filesystem::exists(none));
}

TEST_F(MapProgram, HelpNamesTheCommands) {
  const std::string help = run("--help").said;
  for (const char* command : {"query", "angles", "info", "check", "export", "prune", "merge", "push", "pull"})
    EXPECT_NE(help.find(std::string("  ") + command), std::string::npos) << command;
}

}  // namespace program_test
}  // namespace textslam
