// report.html of whole runs, and --json-lines. Leaves map.html and no-map.html for the test in the browser.
#include <set>

#include "io/image_file.hpp"
#include "io/text_file.hpp"
#include "programs/textslam_support.hpp"

namespace textslam {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr int kFrames = 60;
constexpr const char* kHostile = "</script><img src=x onerror=\"window.broken=1\">'&<!--";

class TextslamReport : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TemporaryFolder;
    render(room(), "room", kFrames, 480);
    // Each frame's first word in the order of the alphabet would do; the same sign must have it in all of them.
    std::map<std::string, int> counts;
    for_each_detection([&](std::string& line) { ++counts[word_of(line)]; });
    const auto most = std::max_element(counts.begin(), counts.end(),
                                       [](const auto& a, const auto& b) { return a.second < b.second; });
    for_each_detection([&](std::string& line) {
      const std::string word = word_of(line);
      if (word == most->first) line = line.substr(0, line.size() - word.size()) + kHostile;
    });
    run_ = new ProgramResult(textslam_program({room(), "--output", output(), "--json-lines"}));
  }
  static void TearDownTestSuite() {
    delete run_;
    delete folder_;
  }

  static std::string room() { return folder_->path("room"); }
  static std::string output(const std::string& name = "") {
    return folder_->path(name.empty() ? "out" : "out/" + name);
  }
  static std::string word_of(const std::string& line) {
    std::size_t at = 0;
    for (int i = 0; i < 8; ++i) at = line.find(',', at) + 1;
    return line.substr(at);
  }
  template <class Change>
  static void for_each_detection(Change change) {
    for (const auto& entry : fs::directory_iterator(room() + "/detections")) {
      std::string all;
      for (const TextLine& line : read_lines(entry.path().string())) {
        std::string text = line.text;
        change(text);
        all += text + "\n";
      }
      std::ofstream(entry.path(), std::ios::binary) << all;
    }
  }

  // Each point has the key frame that saw it first, and a grey value; a room has light and dark ones.
  static void expect_points_are_told(const Json& world) {
    const std::size_t count = world.at("points").size() / 3;
    ASSERT_EQ(world.at("point_frames").size(), count);
    ASSERT_EQ(world.at("point_greys").size(), count);
    std::set<int> keyframes, greys;
    for (const Json& keyframe : world.at("keyframes")) keyframes.insert(keyframe.at("frame").get<int>());
    for (const Json& frame : world.at("point_frames")) EXPECT_EQ(keyframes.count(frame.get<int>()), 1u) << frame;
    for (const Json& grey : world.at("point_greys")) greys.insert(grey.get<int>());
    EXPECT_GT(greys.size(), 20u);
    EXPECT_GE(*greys.begin(), 0);
    EXPECT_LE(*greys.rbegin(), 255);
  }

  static TemporaryFolder* folder_;
  static ProgramResult* run_;
};
TemporaryFolder* TextslamReport::folder_ = nullptr;
ProgramResult* TextslamReport::run_ = nullptr;

TEST_F(TextslamReport, HoldsTheRun) {
  expect_success(*run_);
  expect_all_outputs(output());
  const std::string page = bytes_of(output("report.html"));
  const Json data = Json::parse(report_block(page, "data")), run = Json::parse(report_block(page, "run"));
  const Json metrics = Json::parse(bytes_of(output("metrics.json")));
  const Json map = Json::parse(bytes_of(output("text_map.json"))).at("texts");
  EXPECT_EQ(data.at("summary").at("tracked"), metrics.at("tracked"));
  EXPECT_NEAR(data.at("summary").at("ate_rmse").get<double>(), metrics.at("trajectory").at("ate_rmse").get<double>(),
              1e-6);
  ASSERT_EQ(data.at("texts").size(), map.size());
  ASSERT_GT(map.size(), 2u);
  for (std::size_t i = 0; i < map.size(); ++i) {
    const Json& text = data.at("texts")[i];
    EXPECT_EQ(text.at("id"), map[i].at("id"));
    EXPECT_EQ(text.at("word"), map[i].at("text"));
    EXPECT_EQ(text.at("image").get<std::string>().compare(0, 23, "data:image/jpeg;base64,"), 0);
    EXPECT_TRUE(text.contains("angle_deg"));
    const Json& readings = text.at("readings");
    EXPECT_NE(std::find(readings.begin(), readings.end(), text.at("word")), readings.end());
    for (std::size_t k = 0; k < 12; ++k) {
      const double exact = map[i].at("corners")[k / 3][k % 3];
      EXPECT_NEAR(text.at("corners")[k / 3][k % 3].get<double>(), exact, 1e-5 * (1 + std::abs(exact)));
    }
  }
  EXPECT_EQ(data.at("world").at("points").size(), 3 * metrics.at("points").get<std::size_t>());
  expect_points_are_told(data.at("world"));
  EXPECT_EQ(data.at("world").at("keyframes").size(), metrics.at("keyframes").get<std::size_t>());
  EXPECT_EQ(data.at("world").at("trajectory").size(), static_cast<std::size_t>(kFrames));
  EXPECT_EQ(run.at("command").back(), "--json-lines");
  EXPECT_EQ(run.at("timing").at(0).at("ms").size(), static_cast<std::size_t>(kFrames));
}

// The truth stands in the map where the estimate does, and the errors by frame are those of metrics.json.
TEST_F(TextslamReport, TruthIsAligned) {
  const Json data = Json::parse(report_block(bytes_of(output("report.html")), "data"));
  const Json metrics = Json::parse(bytes_of(output("metrics.json"))).at("trajectory");
  const Json &world = data.at("world"), &errors = data.at("series").at("error");
  ASSERT_EQ(world.at("truth").size(), static_cast<std::size_t>(kFrames));
  const double scale = metrics.at("scale");
  double sum = 0, count = 0;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    if (errors[i].is_null()) continue;
    double squared = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double d = world.at("trajectory")[i][k].get<double>() - world.at("truth")[i][k].get<double>();
      squared += d * d;
    }
    EXPECT_NEAR(scale * std::sqrt(squared), errors[i].get<double>(), 1e-4) << i;
    sum += errors[i].get<double>() * errors[i].get<double>();
    ++count;
  }
  ASSERT_GT(count, 0.9 * kFrames);
  EXPECT_NEAR(std::sqrt(sum / count), metrics.at("ate_rmse").get<double>(), 1e-6);
  EXPECT_GE(world.at("signs").size(), 5u);
}

TEST_F(TextslamReport, FramesShowWhatTheMapKnows) {
  const Json data = Json::parse(report_block(bytes_of(output("report.html")), "data"));
  ASSERT_EQ(data.at("frames").size(), static_cast<std::size_t>(kFrames));
  int texts = 0, detections = 0, good = 0;
  std::size_t points = 0;
  for (const Json& frame : data.at("frames")) {
    detections += static_cast<int>(frame.at("detections").size());
    points += frame.at("points").size() / 2;
    for (const Json& text : frame.at("texts")) {
      ++texts;
      good += text.at("zncc").get<double>() > 0.8 ? 1 : 0;
    }
  }
  EXPECT_GT(texts, 2 * kFrames);
  EXPECT_GT(good, 0.9 * texts);
  EXPECT_GT(detections, kFrames);
  EXPECT_GT(points, 50u * kFrames);
  // The cost: what the final pose explains no worse than the live one did.
  double before = 0, after = 0;
  for (std::size_t i = 0; i < kFrames; ++i) {
    const Json &live = data.at("series").at("cost_live")[i], &last = data.at("series").at("cost")[i];
    if (live.is_null() || last.is_null()) continue;
    before += live.get<double>();
    after += last.get<double>();
  }
  EXPECT_GT(after, 0);
  EXPECT_LE(after, before);
}

TEST_F(TextslamReport, WordsCannotBreakThePage) {
  const std::string page = bytes_of(output("report.html"));
  const Json data = Json::parse(report_block(page, "data"));
  bool found = false;
  for (const Json& text : data.at("texts")) found = found || text.at("word") == kHostile;
  EXPECT_TRUE(found) << "the word itself is there";
  std::size_t opened = 0, closed = 0;
  for (std::size_t at = 0; (at = page.find("<script", at)) != std::string::npos; ++at) ++opened;
  for (std::size_t at = 0; (at = page.find("</script", at)) != std::string::npos; ++at) ++closed;
  EXPECT_EQ(opened, closed);
  EXPECT_EQ(page.find("onerror=\""), std::string::npos);
}

// As 300 frames would be: at most 15 MB.
TEST_F(TextslamReport, Size) {
  EXPECT_LE(300.0 / kFrames * static_cast<double>(fs::file_size(output("report.html"))), 15e6);
}

TEST_F(TextslamReport, JsonLines) {
  std::vector<Json> lines;
  std::istringstream out(run_->out);
  for (std::string line; std::getline(out, line);) {
    ASSERT_TRUE(Json::accept(line)) << line;
    lines.push_back(Json::parse(line));
  }
  ASSERT_EQ(lines.size(), static_cast<std::size_t>(kFrames) + 1);
  const auto live = read_tum(output("trajectory_live.txt"));
  std::size_t tracked = 0;
  for (int i = 0; i < kFrames; ++i) {
    const Json& line = lines[static_cast<std::size_t>(i)];
    EXPECT_EQ(line.at("frame"), i);
    if (line.at("state") != "tracked") continue;
    ASSERT_LT(tracked, live.size());
    const StampedPose& pose = live[tracked++];
    EXPECT_NEAR(line.at("timestamp").get<double>(), pose.timestamp, 1e-9);
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_NEAR(line.at("pose")[k].get<double>(), pose.T_w_c.t[static_cast<int>(k)], 1e-5);
  }
  EXPECT_EQ(tracked, live.size());
  EXPECT_EQ(lines.back().at("summary"), Json::parse(bytes_of(output("metrics.json"))));
}

TEST_F(TextslamReport, CanBeLeftOut) {
  const std::string out = folder_->path("none");
  expect_success(textslam_program({room(), "--output", out, "--last", "3", "--no-report"}));
  EXPECT_TRUE(fs::exists(out + "/metrics.json"));
  EXPECT_FALSE(fs::exists(out + "/report.html"));
}

TEST_F(TextslamReport, WithoutAMap) {
  const std::string blank = folder_->path("blank");
  fs::create_directories(blank + "/images");
  std::string list;
  for (int i = 0; i < 4; ++i) {
    save_png(blank + "/images/" + std::to_string(i) + ".png", Image<std::uint8_t>(480, 360, 90).view());
    list += std::to_string(i) + ".0 images/" + std::to_string(i) + ".png\n";
  }
  std::ofstream(blank + "/images.txt") << list;
  fs::copy(room() + "/camera.yaml", blank + "/camera.yaml");
  expect_no_map(textslam_program({blank, "--output", folder_->path("blank-out")}));
  const std::string page = bytes_of(folder_->path("blank-out/report.html"));
  const Json data = Json::parse(report_block(page, "data"));
  EXPECT_EQ(data.at("summary").at("tracked"), 0);
  EXPECT_EQ(data.at("frames").size(), 4u);
  EXPECT_TRUE(data.at("texts").empty());
  EXPECT_EQ(data.at("series").at("state"), "wwww");

  fs::create_directories(TEXTSLAM_REPORTS);
  for (const auto& [from, to] :
       {std::pair(output("report.html"), "map.html"), std::pair(folder_->path("blank-out/report.html"), "no-map.html")})
    fs::copy_file(from, std::string(TEXTSLAM_REPORTS) + "/" + to, fs::copy_options::overwrite_existing);
}

}  // namespace
}  // namespace textslam
