// Whole runs of the program on rendered rooms: how well, how completely, the same each time, and what the outputs mean.
#include <cmath>
#include <csignal>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "examples/program/textslam_support.hpp"
#include "io/evaluate.hpp"
#include "io/text_file.hpp"

namespace textslam {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using Vec3 = Vector3<double>;

constexpr int kFrames = 80;

Json json_of(const std::string& path) { return Json::parse(bytes_of(path)); }
Vec3 vec3_of(const Json& json) {
  return {json.at(0).get<double>(), json.at(1).get<double>(), json.at(2).get<double>()};
}

// A third of the room's loop, and the program's results on it, made once.
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
  // Every output but the timings, and in the report those and the command, has the same bytes.
  static void expect_same_outputs(const std::string& a, const std::string& b, const std::set<std::string>& but = {}) {
    for (const std::string name : kOutputs) {
      if (but.count(name) > 0) continue;
      EXPECT_TRUE(same_part(a, name) == same_part(b, name)) << name;
    }
  }

  static TemporaryFolder* folder_;
  static ProgramResult* first_;
};
TemporaryFolder* TextslamRun::folder_ = nullptr;
ProgramResult* TextslamRun::first_ = nullptr;

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

TEST_F(TextslamRun, TrajectoriesAndMetricsAgree) {
  const Sequence sequence = read_sequence(room());
  const Json metrics = json_of(output("metrics.json"));
  std::vector<double> times;
  for (const FrameRef& frame : sequence.frames) times.push_back(frame.timestamp);
  const auto is_time = [&](double time) {
    return std::any_of(times.begin(), times.end(), [&](double t) { return std::abs(t - time) < 1e-9; });
  };
  const auto final_poses = read_tum(output("trajectory.txt"));
  const auto live = read_tum(output("trajectory_live.txt"));
  const auto keyframes = read_tum(output("keyframes.txt"));
  for (const auto& poses : {final_poses, live, keyframes})
    for (const StampedPose& pose : poses) EXPECT_TRUE(is_time(pose.timestamp)) << pose.timestamp;
  EXPECT_EQ(final_poses.size(), metrics.at("tracked").get<std::size_t>());
  EXPECT_EQ(live.size(), metrics.at("tracked_live").get<std::size_t>());
  EXPECT_EQ(keyframes.size(), metrics.at("keyframes").get<std::size_t>());

  // A key frame is a frame of the trajectory, at the same place.
  for (const StampedPose& keyframe : keyframes) {
    const auto same = std::find_if(final_poses.begin(), final_poses.end(),
                                   [&](const StampedPose& pose) { return pose.timestamp == keyframe.timestamp; });
    ASSERT_NE(same, final_poses.end()) << keyframe.timestamp;
    EXPECT_LT((same->T_w_c.t - keyframe.T_w_c.t).norm(), 1e-9);
    EXPECT_LT((same->T_w_c.R - keyframe.T_w_c.R).norm(), 1e-9);
  }

  const TrajectoryEvaluation errors = evaluate_trajectory(final_poses, sequence.groundtruth, sequence.frames.size());
  EXPECT_NEAR(metrics.at("trajectory").at("ate_rmse").get<double>(), errors.ate.rmse, 1e-9);
  EXPECT_NEAR(metrics.at("trajectory").at("scale").get<double>(), errors.alignment.scale,
              1e-6 * errors.alignment.scale);
  EXPECT_NEAR(metrics.at("coverage").get<double>(), errors.coverage, 1e-12);
}

// The map begins when two views have parallax; the frames before that get their poses afterwards.
TEST_F(TextslamRun, FillsInFramesBeforeTheMapBegan) {
  const Sequence sequence = read_sequence(room());
  const int began = json_of(output("metrics.json")).at("map_began_at_frame");
  ASSERT_GT(began, 0);
  const auto poses = read_tum(output("trajectory.txt")), live = read_tum(output("trajectory_live.txt"));
  ASSERT_FALSE(live.empty());
  EXPECT_NEAR(live.front().timestamp, sequence.frames[static_cast<std::size_t>(began)].timestamp, 1e-9);
  ASSERT_GE(poses.size(), static_cast<std::size_t>(began));
  std::vector<Vec3> estimate, truth;
  const TrajectoryEvaluation errors = evaluate_trajectory(poses, sequence.groundtruth, sequence.frames.size());
  for (std::size_t i = 0; i < static_cast<std::size_t>(began); ++i) {
    EXPECT_NEAR(poses[i].timestamp, sequence.frames[i].timestamp, 1e-9);
    const Vec3 error = errors.alignment * poses[i].T_w_c.t - sequence.groundtruth[i].T_w_c.t;
    EXPECT_LT(error.norm(), 0.02 * errors.path_length) << "frame " << i;
  }
}

// The text map against its own definition and against the exact quads.
TEST_F(TextslamRun, TextMapIsConsistent) {
  const Sequence sequence = read_sequence(room());
  const Json texts = json_of(output("text_map.json")).at("texts");
  const Json metrics = json_of(output("metrics.json"));
  std::map<int, int> sign_of;
  for (const Json& match : metrics.at("text").at("matches")) sign_of[match.at("text")] = match.at("sign");
  const auto keyframes = read_tum(output("keyframes.txt"));
  ASSERT_FALSE(texts.empty());
  EXPECT_EQ(texts.size(), metrics.at("texts").get<std::size_t>());
  std::set<int> ids;
  for (const Json& text : texts) {
    const int id = text.at("id");
    SCOPED_TRACE("text " + std::to_string(id) + " " + text.at("text").get<std::string>());
    EXPECT_TRUE(ids.insert(id).second);
    EXPECT_GE(text.at("observations").get<int>(), 5);
    EXPECT_GT(text.at("zncc").get<double>(), 0.5);
    EXPECT_LE(text.at("zncc").get<double>(), 1.0);
    const auto host = std::find_if(keyframes.begin(), keyframes.end(), [&](const StampedPose& pose) {
      return std::abs(pose.timestamp - text.at("host").get<double>()) < 1e-9;
    });
    ASSERT_NE(host, keyframes.end()) << "the host is a key frame";
    const SE3d T_h_w = host->T_w_c.inverse();
    const Vec3 theta = vec3_of(text.at("theta")), normal = vec3_of(text.at("normal"));
    EXPECT_LT((normal + host->T_w_c.R * theta.normalized()).norm(), 1e-8);

    // Corners on the plane theta . p = 1, where the sign is in the host's image: a detector's error of 1.5 px a corner.
    ASSERT_EQ(text.at("corners").size(), 4u);
    ASSERT_EQ(sign_of.count(id), 1u);
    const auto frame = std::find_if(sequence.frames.begin(), sequence.frames.end(),
                                    [&](const FrameRef& f) { return std::abs(f.timestamp - host->timestamp) < 1e-9; });
    ASSERT_NE(frame, sequence.frames.end());
    std::vector<double> exact;
    for (const TextLine& line : read_lines(room("truth/quads/" + frame->stem + ".txt"))) {
      std::vector<std::string> fields;
      std::istringstream rest(line.text);
      for (std::string field; std::getline(rest, field, ',');) fields.push_back(field);
      if (std::stoi(fields[fields.size() - 2]) != sign_of[id]) continue;
      for (std::size_t i = 0; i < 8; ++i) exact.push_back(std::stod(fields[i]));
    }
    ASSERT_EQ(exact.size(), sign_of[id] >= 0 ? 8u : 0u) << "the host shows the sign";
    for (std::size_t i = 0; i < 4; ++i) {
      const Vec3 p = T_h_w * vec3_of(text.at("corners").at(i));
      EXPECT_NEAR(theta.dot(p), 1.0, 1e-8);
      ASSERT_GT(p.z(), 0.0);
      const Vector2<double> px = sequence.camera.pinhole.project(p);
      EXPECT_TRUE(px.x() >= 0 && px.y() >= 0 && px.x() < sequence.camera.width && px.y() < sequence.camera.height);
      if (exact.empty()) continue;
      EXPECT_LT((px - Vector2<double>(exact[2 * i], exact[2 * i + 1])).norm(), 8.0) << "corner " << i;
    }
  }
}

TEST_F(TextslamRun, PlyHoldsTheMap) {
  const Json metrics = json_of(output("metrics.json"));
  const std::size_t texts = metrics.at("texts"), points = metrics.at("points"), keyframes = metrics.at("keyframes");
  const std::vector<TextLine> lines = read_lines(output("text_map.ply"));
  std::size_t at = 0, vertices = 0, faces = 0;
  for (; at < lines.size() && lines[at].text != "end_header"; ++at) {
    std::istringstream words(lines[at].text);
    std::string element, name;
    std::size_t count = 0;
    if (words >> element >> name >> count && element == "element") (name == "vertex" ? vertices : faces) = count;
  }
  EXPECT_EQ(lines.front().text, "ply");
  EXPECT_EQ(vertices, 4 * texts + points + keyframes);
  EXPECT_EQ(faces, texts);
  ASSERT_EQ(lines.size(), at + 1 + vertices + faces);
  for (std::size_t i = 0; i < vertices; ++i) {
    const auto words = split_blanks(lines[at + 1 + i].text);
    ASSERT_EQ(words.size(), 6u);
    for (const auto& word : words) {
      double value = 0;
      EXPECT_TRUE(parse_number(word, &value)) << lines[at + 1 + i].text;
    }
  }
  // The first four vertices of each face are the corners of the text map.
  const Json map = json_of(output("text_map.json")).at("texts");
  for (std::size_t i = 0; i < faces; ++i) {
    const auto words = split_blanks(lines[at + 1 + vertices + i].text);
    ASSERT_EQ(words.size(), 5u);
    for (std::size_t k = 0; k < 4; ++k) {
      double index = -1;
      ASSERT_TRUE(parse_number(words[k + 1], &index) && index >= 0 && index < static_cast<double>(vertices));
      std::istringstream vertex(lines[at + 1 + static_cast<std::size_t>(index)].text);
      Vec3 p;
      vertex >> p.x() >> p.y() >> p.z();
      EXPECT_LT((p - vec3_of(map.at(i).at("corners").at(k))).norm(), 1e-5 * (1 + p.norm()));
    }
  }
}

TEST_F(TextslamRun, TheMapIsAskedForWords) {
  const Json map = json_of(output("text_map.json")).at("texts");
  ASSERT_FALSE(map.empty());
  const std::string word = map.at(0).at("text");
  const ProgramResult found = run_program(TEXTSLAM_MAP_PROGRAM, {"query", output(), word, "--json"});
  expect_success(found);
  const Json first = Json::parse(found.out).at("texts").at(0);
  EXPECT_EQ(first.at("text"), word);
  bool known = false;
  for (const Json& text : map)
    if (text.at("id") == first.at("id")) {
      known = true;
      EXPECT_LT((vec3_of(text.at("normal")) - vec3_of(first.at("normal"))).norm(), 1e-12);
    }
  EXPECT_TRUE(known);
  EXPECT_TRUE(std::filesystem::exists(room(first.at("image").get<std::string>())));
  const ProgramResult shown = run_program(TEXTSLAM_MAP_PROGRAM, {"query", output(), word});
  expect_success(shown);
  EXPECT_NE(shown.out.find(first.at("image").get<std::string>()), std::string::npos) << shown.out;
  expect_refused(run_program(TEXTSLAM_MAP_PROGRAM, {"query", output(), "nobody wrote this"}), 1, "no text of ",
                 "nobody wrote this", "textslam-map");
  expect_refused(run_program(TEXTSLAM_MAP_PROGRAM, {"query", output("none"), "EXIT"}), 2,
                 output("none") + "/text_index.json: ", "", "textslam-map");
}

TEST_F(TextslamRun, TheMapIsAskedForAngles) {
  const Json map = json_of(output("text_map.json")).at("texts");
  ASSERT_GE(map.size(), 2u);
  const ProgramResult all = run_program(TEXTSLAM_MAP_PROGRAM, {"angles", output()});
  expect_success(all);
  EXPECT_EQ(static_cast<std::size_t>(std::count(all.out.begin(), all.out.end(), '\n')), map.size() + 2)
      << "a line a text, between the heading and the largest angle:\n"
      << all.out;
  const std::string word = map.at(0).at("text");
  const ProgramResult twice = run_program(TEXTSLAM_MAP_PROGRAM, {"angles", output(), word, word, "--within", "0"});
  expect_success(twice);
  EXPECT_NE(twice.out.find("largest angle 0.00 degrees"), std::string::npos) << twice.out;
  // The room has walls at right angles, and signs on more than one.
  const ProgramResult apart = run_program(TEXTSLAM_MAP_PROGRAM, {"angles", output(), "--within", "1"});
  EXPECT_EQ(apart.code, 1) << apart.out;
  EXPECT_NE(apart.err.find("is more than 1"), std::string::npos) << apart.err;
  expect_refused(run_program(TEXTSLAM_MAP_PROGRAM, {"angles", output(), "nobody wrote this"}), 1, "no text of ",
                 "nobody wrote this", "textslam-map");
}

TEST_F(TextslamRun, TimingsCoverEveryFrame) {
  const Json timing = json_of(output("timing.json"));
  EXPECT_EQ(timing.at("frames").size(), static_cast<std::size_t>(kFrames));
  for (const char* stage : {"detection", "tracking", "mapping"}) {
    const Json& t = timing.at("stages").at(stage);
    EXPECT_GE(t.at("median").get<double>(), 0.0);
    EXPECT_GE(t.at("p95").get<double>(), t.at("median").get<double>());
  }
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
