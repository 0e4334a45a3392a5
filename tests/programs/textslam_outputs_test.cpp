// What the outputs of a run mean: against each other, against the rendered truth, and asked by textslam-map.
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <sstream>

#include "io/evaluate.hpp"
#include "io/text_file.hpp"
#include "programs/textslam_run.hpp"

namespace textslam {
namespace {

using Vec3 = Vector3<double>;

Vec3 vec3_of(const Json& json) {
  return {json.at(0).get<double>(), json.at(1).get<double>(), json.at(2).get<double>()};
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

// Poses between the key frames have a covariance, the key frames' own have none.
TEST_F(TextslamRun, CovariancesAreThoseOfThePosesBetween) {
  const auto keyframes = read_tum(output("keyframes.txt")), poses = read_tum(output("trajectory.txt"));
  std::istringstream table(read_file(output("covariances.csv")));
  std::string line;
  ASSERT_TRUE(std::getline(table, line));
  EXPECT_EQ(std::count(line.begin(), line.end(), ','), 1 + 21);
  std::size_t rows = 0;
  for (; std::getline(table, line); ++rows) {
    const double time = std::stod(line);
    const auto same = [&](const StampedPose& pose) { return std::abs(pose.timestamp - time) < 1e-5; };
    EXPECT_TRUE(std::any_of(poses.begin(), poses.end(), same)) << line;
    EXPECT_TRUE(std::none_of(keyframes.begin(), keyframes.end(), same)) << line;
  }
  EXPECT_EQ(rows, poses.size() - keyframes.size());
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
      const Vector2<double> px = sequence.camera.pinhole().project(p);
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
  const Json& whole = timing.at("stages").at("frame");
  EXPECT_GE(whole.at("p99").get<double>(), whole.at("p95").get<double>());
  double longest = 0;
  for (const Json& frame : timing.at("frames"))
    longest = std::max(longest, frame.at("tracking").get<double>() + frame.at("mapping").get<double>());
  EXPECT_GE(whole.at("longest").get<double>(), whole.at("p99").get<double>());
  EXPECT_LE(whole.at("longest").get<double>(), longest) << "of the live frames, which are some of all";
}

}  // namespace
}  // namespace textslam
