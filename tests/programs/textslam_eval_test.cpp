// The program textslam-eval on a run whose errors a reader can work out by hand, and on broken input.
#include <cmath>
#include <map>

#include "io/text_file.hpp"
#include "programs/textslam_support.hpp"

namespace textslam {
namespace {

namespace fs = std::filesystem;

// Truth: four poses at distance 1 from the origin, on the axes of x and y, none turned. The run stretches the two on
// the axis of x to 1.1, shrinks those on the axis of y to 0.9, and turns the last one by 9 degrees about its own place.
constexpr const char* kTruth = "0 1 0 0 0 0 0 1\n1 0 1 0 0 0 0 1\n2 -1 0 0 0 0 0 1\n3 0 -1 0 0 0 0 1\n";
std::string estimate() {
  const double half = 4.5 / 57.295779513082320877;
  return "# a run\n0 1.1 0 0 0 0 0 1\n1 0 0.9 0 0 0 0 1\n2 -1.1 0 0 0 0 0 1\n3 0 -0.9 0 0 0 " +
         shortest(std::sin(half)) + " " + shortest(std::cos(half)) + "\n";
}

// A sign or text of 1 x 1 whose top left corner is at (x, y, 0), with its normal turned from -z about x.
std::string sign(int id, const std::string& word, double x, double y, double degrees) {
  const auto point = [](double a, double b, double c) {
    return "[" + shortest(a) + "," + shortest(b) + "," + shortest(c) + "]";
  };
  const double angle = degrees / 57.295779513082320877;
  return "{\"id\":" + std::to_string(id) + ",\"text\":\"" + word + "\",\"corners\":[" + point(x, y, 0) + "," +
         point(x + 1, y, 0) + "," + point(x + 1, y + 1, 0) + "," + point(x, y + 1, 0) +
         "],\"normal\":" + point(0, std::sin(angle), -std::cos(angle)) + "}";
}

class TextslamEval : public testing::Test {
 protected:
  TextslamEval() {
    folder_.write("run/trajectory.txt", estimate());
    folder_.write("truth/groundtruth.txt", kTruth);
  }
  // Ten frames show five signs, one less shows a sixth, which therefore does not count. Four of the five are mapped,
  // 0.01 to 0.04 beside their place and turned by 0.9 to 3.9 degrees, one with a wrong word; one text is where no sign
  // is.
  void add_signs() {
    std::string signs, texts, images;
    for (int i = 0; i < 6; ++i) signs += (i > 0 ? ",\n" : "") + sign(i, "SIGN" + std::to_string(i), 10 * i, 0, 0);
    for (int i = 0; i < 4; ++i)
      texts += sign(i + 20, i == 2 ? "S1GN2" : "SIGN" + std::to_string(i), 10 * i, 0.01 * (i + 1), i + 0.9) + ",\n";
    texts += sign(30, "GHOST", 5, 0, 0);
    folder_.write("truth/truth/signs.json", "{\"signs\":[" + signs + "]}\n");
    folder_.write("run/text_map.json", "{\"texts\":[\n" + texts + "]}\n");
    for (int frame = 0; frame < 10; ++frame) {
      const std::string stem = "00000" + std::to_string(frame);
      images += std::to_string(frame) + " images/" + stem + ".png\n";
      std::string quads;
      for (int i = 0; i < (frame < 9 ? 6 : 5); ++i)
        quads += "0,0,9,0,9,9,0,9,SIGN" + std::to_string(i) + "," + std::to_string(i) + ",1\n";
      folder_.write("truth/truth/quads/" + stem + ".txt", quads);
    }
    folder_.write("truth/images.txt", images);
  }

  ProgramResult eval(std::vector<std::string> more = {}) const {
    more.insert(more.begin(), {folder_.path("run"), "--truth", folder_.path("truth")});
    return run_program(TEXTSLAM_EVAL_PROGRAM, more);
  }
  std::map<std::string, std::string> csv(std::vector<std::string> more) const {
    more.push_back("--csv");
    const ProgramResult result = eval(more);
    expect_success(result);
    std::istringstream lines(result.out);
    std::string names, values;
    std::getline(lines, names);
    std::getline(lines, values);
    std::map<std::string, std::string> out;
    std::istringstream name_list(names), value_list(values + ",");
    for (std::string name, value; std::getline(name_list, name, ',') && std::getline(value_list, value, ',');)
      out[name] = value;
    return out;
  }
  static void expect_numbers(const std::map<std::string, std::string>& fields,
                             const std::map<std::string, double>& numbers) {
    for (const auto& [name, expected] : numbers) {
      ASSERT_EQ(fields.count(name), 1u) << name;
      double value = -1;
      ASSERT_TRUE(parse_number(fields.at(name), &value)) << name << " is '" << fields.at(name) << "'";
      EXPECT_NEAR(value, expected, 1e-5) << name;
    }
  }
  void expect_bad(const std::string& place, const std::string& part) const {
    expect_refused(eval(), 2, place, part, "textslam-eval");
  }

  TemporaryFolder folder_;
};

TEST_F(TextslamEval, TrajectoryByHandWithoutScale) {
  // By symmetry nothing moves, each pose is off by 0.1, and each step, between neighbours at a right angle, by 0.1 both
  // ways.
  expect_numbers(csv({"--scale", "se3"}),
                 {{"poses", 4},
                  {"pairs", 4},
                  {"path_length", 3 * std::sqrt(2.0)},
                  {"scale", 1},
                  {"ate_rmse", 0.1},
                  {"ate_median", 0.1},
                  {"ate_p90", 0.1},
                  {"ate_max", 0.1},
                  {"rpe_frame_rmse", std::sqrt(0.02)},
                  {"rpe_distance_rmse", std::sqrt(0.02)},
                  {"rpe_frame_p90", std::sqrt(0.02)},
                  // 0, 0 and 9 degrees; 0.9 of the way through them in order is 0.8 of the way from 0 to 9
                  {"rpe_frame_deg_rmse", std::sqrt(27.0)},
                  {"rpe_frame_deg_median", 0},
                  {"rpe_frame_deg_p90", 7.2},
                  {"rpe_distance_deg_max", 9}});
}

TEST_F(TextslamEval, TrajectoryByHandWithScale) {
  // scale = sum to.from / sum from^2 = (1.1 + 1.1 + 0.9 + 0.9) / (2 * 1.21 + 2 * 0.81)
  const double scale = 4 / 4.04, stretched = 1.1 * scale - 1, shrunk = 1 - 0.9 * scale;
  const double rmse = std::sqrt((stretched * stretched + shrunk * shrunk) / 2);
  expect_numbers(csv({}), {{"scale", scale},
                           {"ate_rmse", rmse},
                           {"ate_max", shrunk},
                           {"ate_median", (stretched + shrunk) / 2},
                           {"rpe_frame_rmse", rmse * std::sqrt(2.0)}});
}

TEST_F(TextslamEval, SignsByHand) {
  add_signs();
  expect_numbers(csv({"--scale", "se3"}),
                 {{"frames", 10},
                  {"coverage", 0.4},
                  {"signs_visible", 5},
                  {"signs_mapped", 4},
                  {"texts_matched", 4},
                  {"texts_false", 1},
                  {"words_right", 3},
                  // 0.9, 1.9, 2.9, 3.9: the 90th percentile is 0.7 of the way from the third to the fourth
                  {"angle_deg_median", 2.4},
                  {"angle_deg_p90", 3.6},
                  {"angle_deg_max", 3.9},
                  {"centre_median", 0.025},
                  {"centre_p90", 0.037},
                  {"centre_max", 0.04},
                  {"angle_to_0.25", 0},
                  {"angle_to_0.5", 0},
                  {"angle_to_1", 1},
                  {"angle_to_2", 1},
                  {"angle_to_5", 2},
                  {"angle_to_10", 0},
                  {"angle_above_10", 0}});
}

TEST_F(TextslamEval, WhatIsNotKnownIsEmpty) {
  const auto fields = csv({});
  for (const char* name : {"frames", "coverage", "ate_live_rmse", "signs_visible", "angle_deg_median", "angle_to_1"})
    EXPECT_EQ(fields.at(name), "") << name;
  EXPECT_EQ(fields.at("status"), "ok");
  folder_.write("run/trajectory.txt", "0 0 0 0 0 0 0 1\n");
  const auto lost = csv({});
  EXPECT_EQ(lost.at("status"), "too_few");
  EXPECT_EQ(lost.at("ate_rmse"), "");
  EXPECT_EQ(lost.at("poses"), "1");
}

TEST_F(TextslamEval, FramesAskedForAreThoseOfTheRun) {
  add_signs();
  folder_.write("run/metrics.json", "{\"frames\":8}");
  folder_.write("run/trajectory_live.txt", estimate());
  const auto fields = csv({"--scale", "se3"});
  EXPECT_EQ(fields.at("coverage"), "0.5");
  EXPECT_EQ(fields.at("ate_live_rmse"), "0.1");
}

TEST_F(TextslamEval, FormatsAndSeveralRuns) {
  add_signs();
  fs::copy(folder_.path("run"), folder_.path("again"));
  fs::copy(folder_.path("truth"), folder_.path("again/sequence"), fs::copy_options::recursive);
  const ProgramResult table = eval({folder_.path("again"), "--markdown", "--scale", "se3"});
  expect_success(table);
  EXPECT_EQ(table.out.compare(0, 7, "| run |"), 0) << table.out;
  EXPECT_NE(table.out.find("\n| angle_deg_median | 2.4 | 2.4 |\n"), std::string::npos) << table.out;
  const ProgramResult text = eval({"--scale", "se3"});
  expect_success(text);
  EXPECT_NE(text.out.find("  angle_deg_p90             3.6\n"), std::string::npos) << text.out;
  EXPECT_NE(text.out.find("  ate_live_rmse             -\n"), std::string::npos) << text.out;
  // A run that was rendered brings its truth along.
  expect_success(run_program(TEXTSLAM_EVAL_PROGRAM, {folder_.path("again")}));
}

TEST_F(TextslamEval, BrokenInputNamesFileAndLine) {
  const std::string run = folder_.path("run"), truth = folder_.path("truth");
  folder_.write("run/trajectory.txt", "0 0 0 0 0 0 0 1\n1 0 zero 0 0 0 0 1\n");
  expect_bad(run + "/trajectory.txt:2: ", "'zero'");
  folder_.write("run/trajectory.txt", estimate());
  folder_.write("truth/groundtruth.txt", "0 0 0 0 0 0 0 1\n0 0 0 0 0 0 0 1\n");
  expect_bad(truth + "/groundtruth.txt:2: ", "times must increase");
  folder_.write("truth/groundtruth.txt", kTruth);
  add_signs();
  folder_.write("run/text_map.json", "{\"texts\":[\n{\"id\":1,\n]}");
  expect_bad(run + "/text_map.json:3: ", "parse error");
  folder_.write("run/text_map.json", "{\"texts\":[" + sign(1, "A", 0, 0, 0) + ",{\"id\":2}]}");
  expect_bad(run + "/text_map.json: ", "texts[1]");
  folder_.write("run/text_map.json", "{\"texts\":[{\"id\":1e999}]}");
  expect_bad(run + "/text_map.json: ", "number overflow");
  folder_.write("run/text_map.json", "[]");
  expect_bad(run + "/text_map.json: ", "no list 'texts'");
  folder_.write("run/text_map.json", "{\"texts\":[]}");
  folder_.write("truth/truth/quads/000003.txt", "0,0,9,0,9,9,0,9,SIGN0,0,all\n");
  expect_bad(truth + "/truth/quads/000003.txt:1: ", "'all'");
  fs::remove(folder_.path("truth/truth/quads/000003.txt"));
  folder_.write("truth/images.txt", "0 images/000000.png\none\n");
  expect_bad(truth + "/images.txt:2: ", "the timestamp should be a finite number, not 'one'");
  fs::remove(folder_.path("truth/images.txt"));
  folder_.write("run/metrics.json", "{\"frames\":\"many\"}");
  expect_bad(run + "/metrics.json: ", "frames");
}

TEST_F(TextslamEval, MissingInputAndWrongOptions) {
  const auto refused = [](const std::vector<std::string>& arguments, const std::string& place,
                          const std::string& part) {
    expect_refused(run_program(TEXTSLAM_EVAL_PROGRAM, arguments), 2, place, part, "textslam-eval");
  };
  const std::string run = folder_.path("run");
  refused({}, "", "RUN");
  refused({folder_.path("none")}, folder_.path("none") + ": ", "no such folder");
  refused({run}, run + "/sequence: ", "--truth");
  refused({run, "--scale", "sim2"}, "", "--scale");
  refused({run, "--csv", "--markdown"}, "", "--csv");
  fs::remove(run + "/trajectory.txt");
  expect_bad(run + "/trajectory.txt: ", "No such file");
}

}  // namespace
}  // namespace textslam
