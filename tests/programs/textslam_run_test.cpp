// Whole runs of the program on rendered rooms: how well, how completely, and the same each time, in every mode.
#include <csignal>
#include <set>

#include "io/text_file.hpp"
#include "programs/textslam_run.hpp"

namespace textslam {
namespace {

namespace fs = std::filesystem;

// Every output but the timings, and in the report those and the command, has the same bytes.
void expect_same_outputs(const std::string& a, const std::string& b, const std::set<std::string>& but = {}) {
  for (const std::string name : kOutputs) {
    if (but.count(name) > 0) continue;
    EXPECT_TRUE(same_part(a, name) == same_part(b, name)) << name;
  }
}

TEST_F(TextslamRun, TracksAndMapsWell) {
  expect_success(*first_);
  expect_all_outputs(output());
  const Json metrics = json_of(output("metrics.json"));
  EXPECT_EQ(metrics.at("frames"), kFrames);
  EXPECT_GE(metrics.at("coverage").get<double>(), 0.9);
  const Json& trajectory = metrics.at("trajectory");
  EXPECT_EQ(trajectory.at("status"), "ok");
  EXPECT_LE(trajectory.at("ate_rmse").get<double>(), 0.01 * trajectory.at("path_length").get<double>());
  // Signs that came into view late cannot have their observations yet: half of them, not 70 % as of the whole loop.
  const Json& text = metrics.at("text");
  EXPECT_GE(text.at("signs_visible").get<int>(), 5);
  EXPECT_GE(2 * text.at("signs_mapped").get<int>(), text.at("signs_visible").get<int>());
  EXPECT_LE(text.at("angle_median_deg").get<double>(), 1.5);
  EXPECT_LE(text.at("false_texts").get<int>(), 1);
}

TEST_F(TextslamRun, PrintsTheTable) {
  for (const char* row : {"frames tracked", "ATE (Sim(3))", "RPE", "text objects", "angle error", "ms a frame"})
    EXPECT_NE(first_->out.find(row), std::string::npos) << row << " in\n" << first_->out;
  EXPECT_NE(first_->out.find(output()), std::string::npos) << "where the results are";
}

TEST_F(TextslamRun, SameBytesAgain) {
  expect_success(run(room(), "again"));
  expect_same_outputs(output(), folder_->path("again"));
}

// The truth is for the errors in metrics.json and the report alone, groundtruth.txt included.
TEST_F(TextslamRun, NeverReadsTheTruth) {
  const std::string blind = folder_->path("blind");
  fs::copy(room(), blind, fs::copy_options::recursive);
  fs::remove_all(blind + "/truth");
  fs::remove(blind + "/groundtruth.txt");
  expect_success(run(blind, "blind-out"));
  expect_same_outputs(output(), folder_->path("blind-out"), {"metrics.json", "report.html"});
  const Json metrics = json_of(folder_->path("blind-out/metrics.json"));
  EXPECT_FALSE(metrics.contains("trajectory"));
  EXPECT_FALSE(metrics.contains("text"));
}

TEST_F(TextslamRun, PointsModeKnowsNoText) {
  const std::string broken = folder_->path("broken-detections");
  fs::copy(room(), broken, fs::copy_options::recursive);
  for (const auto& entry : fs::directory_iterator(broken + "/detections"))
    std::ofstream(entry.path(), std::ios::binary) << "not a detection\n";
  expect_success(run(room(), "points", {"--mode", "points"}));
  expect_success(run(broken, "points-broken", {"--mode", "points"}));
  expect_same_outputs(folder_->path("points"), folder_->path("points-broken"));
  const Json metrics = json_of(folder_->path("points/metrics.json"));
  EXPECT_EQ(metrics.at("texts"), 0);
  EXPECT_GE(metrics.at("coverage").get<double>(), 0.9);
  EXPECT_TRUE(json_of(folder_->path("points/text_map.json")).at("texts").empty());
}

// Loose planes come after tracking and adjustment: poses and points are those of mode points, to the byte.
TEST_F(TextslamRun, LooseModeMapsTextThatNothingElseKnows) {
  expect_success(run(room(), "points-alone", {"--mode", "points"}));
  expect_success(run(room(), "loose", {"--mode", "loose"}));
  expect_all_outputs(folder_->path("loose"));
  for (const char* name : {"trajectory.txt", "trajectory_live.txt", "keyframes.txt"})
    EXPECT_TRUE(bytes_of(folder_->path("loose/") + name) == bytes_of(folder_->path("points-alone/") + name)) << name;
  const Json metrics = json_of(folder_->path("loose/metrics.json"));
  EXPECT_EQ(metrics.at("points"), json_of(folder_->path("points-alone/metrics.json")).at("points"));
  const Json& text = metrics.at("text");
  EXPECT_GE(2 * text.at("signs_mapped").get<int>(), text.at("signs_visible").get<int>());
  EXPECT_LE(text.at("angle_median_deg").get<double>(), 8.0);
  EXPECT_LE(text.at("false_texts").get<int>(), 1);
  EXPECT_EQ(json_of(folder_->path("loose/text_map.json")).at("texts").size(), metrics.at("texts").get<std::size_t>());
}

TEST_F(TextslamRun, RunsWithTheClassicalDetector) {
  const std::string bare = folder_->path("no-detections");
  fs::copy(room(), bare, fs::copy_options::recursive);
  fs::remove_all(bare + "/detections");
  expect_success(run(bare, "classical", {"--detector", "classical"}));
  const Json metrics = json_of(folder_->path("classical/metrics.json"));
  EXPECT_GE(metrics.at("coverage").get<double>(), 0.9);
  EXPECT_LE(metrics.at("trajectory").at("ate_rmse").get<double>(),
            0.01 * metrics.at("trajectory").at("path_length").get<double>());
}

// What it gives depends on timing, but not how good it is.
TEST_F(TextslamRun, RealTime) {
  const ProgramResult result = run(room(), "real-time", {"--real-time"});
  expect_success(result);
  expect_all_outputs(folder_->path("real-time"));
  const Json metrics = json_of(folder_->path("real-time/metrics.json"));
  EXPECT_GE(metrics.at("coverage").get<double>(), 0.9);
  const Json& trajectory = metrics.at("trajectory");
  EXPECT_LE(trajectory.at("ate_rmse").get<double>(), 0.01 * trajectory.at("path_length").get<double>());
  EXPECT_GE(2 * metrics.at("text").at("signs_mapped").get<int>(), metrics.at("text").at("signs_visible").get<int>());
  EXPECT_GT(json_of(folder_->path("real-time/timing.json")).at("stages").at("latency").at("median").get<double>(), 0);
  EXPECT_NE(result.out.find("latency"), std::string::npos);
  EXPECT_FALSE(json_of(output("timing.json")).at("stages").contains("latency")) << "of a run that was not in real time";
}

// Detections come late then, and signs are mapped all the same; the sequence's own are not looked at.
TEST_F(TextslamRun, RealTimeWithADetectorBesideIt) {
  expect_success(run(room(), "beside", {"--real-time", "--detector", "classical"}));
  expect_all_outputs(folder_->path("beside"));
  const Json metrics = json_of(folder_->path("beside/metrics.json"));
  EXPECT_GE(metrics.at("coverage").get<double>(), 0.9);
  const Json& trajectory = metrics.at("trajectory");
  EXPECT_LE(trajectory.at("ate_rmse").get<double>(), 0.01 * trajectory.at("path_length").get<double>());
  EXPECT_GE(metrics.at("text").at("signs_mapped").get<int>(), 1);
}

// In real time most of the run is still to come after ten frames; what came before the signal is written.
TEST_F(TextslamRun, AnInterruptKeepsWhatIsComputed) {
  const std::string interrupt =
      "lines=$1; signal=$2; shift 2; \"$@\" >\"$lines\" & run=$!; "
      "until [ \"$(wc -l <\"$lines\")\" -ge 10 ] || ! kill -0 $run; do sleep 0.01; done; "
      "kill -s \"$signal\" $run; wait $run";
  for (const char* signal : {"INT", "TERM"}) {
    const std::string out = folder_->path(std::string("interrupted-") + signal);
    const ProgramResult result =
        run_program("sh", {"-c", interrupt, "sh", folder_->path(std::string("lines-") + signal), signal,
                           TEXTSLAM_PROGRAM, room(), "--output", out, "--real-time", "--json-lines"});
    EXPECT_EQ(result.code, 128 + (signal == std::string("INT") ? SIGINT : SIGTERM)) << result.err;
    EXPECT_NE(result.err.find("interrupted after frame "), std::string::npos) << result.err;
    expect_all_outputs(out);
    EXPECT_LT(read_tum(out + "/trajectory.txt").size(), static_cast<std::size_t>(kFrames));
    EXPECT_EQ(json_of(out + "/metrics.json").at("frames"), kFrames) << "those not processed count as not tracked";
  }
}

// A folder in place of a file stands for a disk that refuses one: the other files are there, and the line names it.
TEST_F(TextslamRun, OneOutputThatCannotBeWrittenCostsNoOther) {
  const std::string out = folder_->path("refused");
  fs::create_directories(out + "/text_map.json/in-the-way");
  const ProgramResult result = run(room(), "refused", {"--last", "5"});
  expect_refused(result, 1, out + "/text_map.json", "cannot write");
  for (const char* name : kOutputs)
    EXPECT_EQ(fs::is_regular_file(out + "/" + name), name != std::string("text_map.json")) << name;
}

// A part of a sequence is a sequence: the same as a folder that holds no more than that part.
TEST_F(TextslamRun, RangeIsASequence) {
  const std::string part = folder_->path("part");
  fs::copy(room(), part, fs::copy_options::recursive);
  const Sequence sequence = read_sequence(room());
  std::string list;
  const auto lines = read_lines(sequence.images_file);
  for (const TextLine& line : lines)
    if (line.number >= sequence.frames[10].line && line.number <= sequence.frames[39].line) list += line.text + "\n";
  std::ofstream(part + "/images.txt", std::ios::binary) << list;
  expect_success(run(room(), "range", {"--first", "10", "--last", "39"}));
  expect_success(run(part, "part-out"));
  expect_same_outputs(folder_->path("range"), folder_->path("part-out"), {"metrics.json", "report.html"});
  EXPECT_EQ(json_of(folder_->path("range/metrics.json")).at("frames"), 30);
}

// The one command that needs no input; the same as rendering and running apart.
TEST_F(TextslamRun, RendersAndRuns) {
  const auto render_notext = [](const std::string& name, std::vector<std::string> more) {
    more.insert(more.begin(), {"--render", "notext", "--seed", "3", "--output", folder_->path(name)});
    return textslam_program(more);
  };
  expect_success(render_notext("rendered", {"--frames", "12"}));
  expect_all_outputs(folder_->path("rendered"), {"sequence"});
  EXPECT_EQ(json_of(folder_->path("rendered/metrics.json")).at("frames"), 12);
  EXPECT_EQ(json_of(folder_->path("rendered/metrics.json")).at("texts"), 0);
  expect_success(run(folder_->path("rendered/sequence"), "apart", {"--seed", "3"}));
  expect_same_outputs(folder_->path("rendered"), folder_->path("apart"));

  expect_success(render_notext("only", {"--frames", "2", "--render-only"}));
  EXPECT_FALSE(fs::exists(folder_->path("only/trajectory.txt")));
  for (const char* image : {"images/000000.png", "images/000001.png"})
    EXPECT_TRUE(bytes_of(folder_->path("only/sequence/") + image) ==
                bytes_of(folder_->path("rendered/sequence/") + image));
}

}  // namespace
}  // namespace textslam
