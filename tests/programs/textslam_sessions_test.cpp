// Sessions in one map: saved, localised in, gone on in. In this process, as textslam runs them.
#include <algorithm>
#include <cmath>
#include <sstream>

#include "io/evaluate_signs.hpp"
#include "io/input_error.hpp"
#include "io/text_file.hpp"
#include "programs/sessions_support.hpp"
#include "support/long_test.hpp"
#include "textplane/landmarks/words.hpp"
#include "textslam/map_file/map_file.hpp"
#include "textslam/text/text_centre.hpp"
#include "textslam_map/colmap_scene.hpp"

namespace textslam {
namespace {

TEST_F(Sessions, AnotherWalkIsLocalisedInTheMapsFrame) {
  RunOptions options = options_for("second", "out_localised");
  options.map = path("map.db");
  options.localise = true;
  const std::string before = read_file(options.map);
  const RunResult result = run(options);
  EXPECT_EQ(result.error, "");
  EXPECT_EQ(result.unmapped, "");
  EXPECT_EQ(read_file(options.map), before) << "localising changed the map";
  EXPECT_GE(result.summary.tracked, 45u);
  const std::vector<double> errors = errors_of("out_localised", "second");
  ASSERT_GE(errors.size(), 45u);
  EXPECT_LT(error_statistics(errors).median, 0.01);
  EXPECT_LT(error_statistics(errors).max, 0.06) << "a wrong pose";

  std::istringstream table(read_file(path("out_localised/localisation.csv")));
  std::string line;
  std::getline(table, line);
  EXPECT_EQ(line, "timestamp,found_by,points,texts,position_sigma");
  std::size_t lines = 0, found = 0;
  while (std::getline(table, line)) {
    ++lines;
    found += line.find(",nothing,") == std::string::npos ? 1u : 0u;
  }
  EXPECT_EQ(lines, 50u);
  EXPECT_EQ(found, result.summary.tracked);
  const std::string covariances = read_file(path("out_localised/covariances.csv"));
  EXPECT_EQ(static_cast<std::size_t>(std::count(covariances.begin(), covariances.end(), '\n')), 1 + found);
}

TEST_F(Sessions, ASecondSessionGoesOnInTheMap) {
  RunOptions options = options_for("second", "out_second");
  options.map = copy_of_map("grown.db");
  const LoadedMap before = load_map(options.map, options.parameters);
  const RunResult result = run(options);
  EXPECT_EQ(result.error, "");
  EXPECT_EQ(result.unmapped, "");
  const LoadedMap after = load_map(options.map, options.parameters);
  EXPECT_EQ(after.record.revision, before.record.revision + 1);
  ASSERT_EQ(after.record.sessions.size(), 2u);
  EXPECT_EQ(after.record.sessions[1].frames, 50);
  std::size_t added = 0;
  for (const auto& [id, source] : after.record.sources) added += source.session == 2 ? 1u : 0u;
  EXPECT_GT(added, 0u);
  EXPECT_EQ(added, read_tum(path("out_second/keyframes.txt")).size()) << "keyframes.txt has those of this session";
  EXPECT_LT(error_statistics(errors_of("out_second", "second")).median, 0.01);
  // The signs of the first session are still the same objects, where they were.
  std::size_t kept = 0, mapped = 0;
  for (std::size_t i = 0; i < before.map.texts.size(); ++i) {
    if (before.map.texts[i].state != TextState::mapped) continue;
    ++mapped;
    kept += after.map.texts[i].state == TextState::mapped ? 1u : 0u;
  }
  EXPECT_GE(kept + 1, mapped);
  EXPECT_LT((after.map.keyframe(0).T_w_c.t - before.map.keyframe(0).T_w_c.t).norm(), 1e-9);
  EXPECT_LT(fs::file_size(path("grown.db")), 2 * fs::file_size(path("map.db"))) << "images are written once";
}

// The page has the key frames in the order of the sessions. It is left for the test in the browser.
TEST_F(Sessions, AreToldApartInTheReportOfTheMap) {
  RunOptions options = options_for("second", "out_for_report");
  options.map = copy_of_map("two.db");
  ASSERT_EQ(run(options).error, "");
  const ProgramResult shown =
      run_program(TEXTSLAM_MAP_PROGRAM, {"report", options.map, "--output", path("sessions.html")});
  EXPECT_EQ(shown.code, 0) << shown.err;
  EXPECT_EQ(shown.out, "");
  const std::string page = bytes_of(path("sessions.html"));
  const auto data = nlohmann::json::parse(report_block(page, "data"));
  const auto map = load_map(options.map, options.parameters);
  ASSERT_EQ(data.at("sessions").size(), 2u);
  const auto of_session = data.at("series").at("session").get<std::vector<int>>();
  EXPECT_EQ(of_session.size(), map.map.keyframe_ids().size());
  EXPECT_TRUE(std::is_sorted(of_session.begin(), of_session.end()));
  const auto times = data.at("series").at("time").get<std::vector<double>>();
  EXPECT_TRUE(std::is_sorted(times.begin(), times.end()));
  for (const auto& session : data.at("sessions")) {
    EXPECT_GT(session.at("keyframes"), 0);
    EXPECT_EQ(session.at("keyframes"), std::count(of_session.begin(), of_session.end(), session.at("id").get<int>()));
  }
  EXPECT_EQ(data.at("sessions")[1].at("frames"), 50);
  for (const auto& text : data.at("texts")) EXPECT_LT(text.at("host").get<std::size_t>(), of_session.size());
  for (const auto& cost : data.at("series").at("cost")) EXPECT_LT(cost.get<double>(), 1.5) << "px";
  std::size_t seen = 0;
  for (const auto& frame : data.at("frames"))
    for (const auto& text : frame.at("texts")) seen += text.at("zncc").get<double>() > 0.8 ? 1u : 0u;
  EXPECT_GT(seen, of_session.size()) << "key frames show the texts where the map has them";

  fs::create_directories(TEXTSLAM_REPORTS);
  fs::copy_file(path("sessions.html"), std::string(TEXTSLAM_REPORTS) + "/sessions.html",
                fs::copy_options::overwrite_existing);
}

TEST_F(Sessions, ASessionCanBeSavedElsewhere) {
  RunOptions options = options_for("second", "out_elsewhere");
  options.map = path("map.db");
  options.save_map = path("another.db");
  const std::string before = read_file(options.map);
  EXPECT_EQ(run(options).error, "");
  EXPECT_EQ(read_file(options.map), before);
  EXPECT_EQ(load_map(options.save_map, options.parameters).record.sessions.size(), 2u);
}

// Each image by itself; of another room none.
TEST_F(Sessions, SingleImagesAreFound) {
  const Similarity alignment =
      evaluate_trajectory(read_tum(path("out_first/trajectory.txt")), read_tum(path("first/groundtruth.txt")), 110)
          .alignment;
  const auto truth = read_tum(path("second/groundtruth.txt"));
  std::vector<std::string> arguments = {"find", path("map.db"), "--json", "--detections", path("second/detections")};
  for (const char* name : {"000000", "000015", "000030", "000045"})
    arguments.push_back(path("second/images/") + name + ".png");
  const ProgramResult found = run_program(TEXTSLAM_MAP_PROGRAM, arguments);
  EXPECT_EQ(found.code, 0) << found.out << found.err;
  const auto images = nlohmann::json::parse(found.out).at("images");
  ASSERT_EQ(images.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(images[i].at("found_by"), "texts");
    EXPECT_GT(images[i].at("probability").get<double>(), 0.1);
    EXPECT_FALSE(images[i].at("words").empty());
    const auto& pose = images[i].at("T_w_c");
    const Vec3 at(pose[0], pose[1], pose[2]);
    EXPECT_LT((alignment * at - truth[15 * i].T_w_c.t).norm(), 0.06);
  }
  const ProgramResult none = run_program(
      TEXTSLAM_MAP_PROGRAM,
      {"find", path("map.db"), path("elsewhere/images/000010.png"), "--detections", path("elsewhere/detections")});
  EXPECT_EQ(none.code, 1);
  EXPECT_EQ(none.out, path("elsewhere/images/000010.png") + ": not found\n");
}

// A map that went through COLMAP's model has its points, finds its texts again, and can be localised in.
TEST_F(Sessions, AModelOfColmapBecomesAMap) {
  const Parameters parameters;
  const LoadedMap map = load_map(path("map.db"), parameters);
  ASSERT_EQ(run_program(TEXTSLAM_MAP_PROGRAM, {"export", path("map.db"), "--colmap", path("model")}).code, 0);
  fs::create_directory(path("boxes"));
  for (const ColmapScene::Image& image : read_colmap_scene(path("model")).images) {
    const std::string taken = fs::path(map.record.sources.at(image.id - 1).image).stem().string();
    fs::copy_file(path("first/detections/" + taken + ".txt"),
                  path("boxes/" + fs::path(image.name).stem().string() + ".txt"));
  }
  const ProgramResult made =
      run_program(TEXTSLAM_MAP_PROGRAM, {"import", path("model"), "--images", path("model/images"), "--detections",
                                         path("boxes"), "--output", path("imported.db")});
  EXPECT_EQ(made.code, 0) << made.err;
  const LoadedMap imported = load_map(path("imported.db"), parameters);
  EXPECT_EQ(imported.map.keyframe_ids().size(), map.map.keyframe_ids().size());
  const auto mapped = [](const LoadedMap& m) {
    return std::count_if(m.map.texts.begin(), m.map.texts.end(),
                         [](const TextObject& text) { return text.state == TextState::mapped; });
  };
  EXPECT_GE(mapped(imported), mapped(map) - 2);
  for (const TextObject& text : imported.map.texts) {
    if (text.state != TextState::mapped) continue;
    double nearest = 1;
    for (const TextObject& other : map.map.texts)
      if (other.state == TextState::mapped)
        nearest = std::min(nearest, (text_centre(imported.map, text).at - text_centre(map.map, other).at).norm());
    EXPECT_LT(nearest, 0.01) << textplane::consensus(text.votes);
  }
  const ProgramResult found = run_program(
      TEXTSLAM_MAP_PROGRAM,
      {"find", path("imported.db"), path("second/images/000015.png"), "--detections", path("second/detections")});
  EXPECT_EQ(found.code, 0) << found.out << found.err;
}

// Another room, with other signs: no wrong answer, and no harm to the map.
TEST_F(Sessions, AnotherRoomIsNotFound) {
  TEXTPLANE_LONG_TEST();
  RunOptions options = options_for("elsewhere", "out_not_found");
  options.map = path("map.db");
  options.localise = true;
  RunResult result = run(options);
  EXPECT_EQ(result.summary.tracked, 0u);
  EXPECT_NE(result.unmapped.find("no frame was found"), std::string::npos) << result.unmapped;

  options.localise = false;
  const std::string before = read_file(options.map);
  result = run(options);
  EXPECT_NE(result.unmapped.find("unjoined_map.db"), std::string::npos) << result.unmapped;
  EXPECT_EQ(read_file(options.map), before);
  const LoadedMap apart = load_map(path("out_not_found/unjoined_map.db"), options.parameters);
  EXPECT_EQ(apart.record.sessions.size(), 1u);
  EXPECT_GE(apart.map.keyframe_ids().size(), 2u);
}

TEST_F(Sessions, AnotherCameraIsRefused) {
  render("smaller", 1, 0, 2, 160);
  RunOptions options = options_for("smaller", "out_smaller");
  options.map = path("map.db");
  EXPECT_THROW(run(options), InputError);
  const std::string camera = read_file(path("second/camera.yaml"));
  fs::copy(path("second"), path("other_camera"), fs::copy_options::recursive);
  folder_->write("other_camera/camera.yaml", camera.substr(0, camera.find("Camera.fx")) + "Camera.fx: 200\n" +
                                                 camera.substr(camera.find("Camera.fy")));
  options.sequence = path("other_camera");
  EXPECT_THROW(run(options), InputError);
}

// A sequence without a camera file takes the map's camera, and nothing is calibrated.
TEST_F(Sessions, AVideoWithoutACameraTakesThatOfTheMap) {
  fs::copy(path("second"), path("no_camera"), fs::copy_options::recursive);
  fs::remove(path("no_camera/camera.yaml"));
  RunOptions options = options_for("no_camera", "out_no_camera");
  options.map = path("map.db");
  options.localise = true;
  const RunResult result = run(options);
  EXPECT_GE(result.summary.tracked, 45u);
  EXPECT_FALSE(result.summary.calibration.has_value());
  EXPECT_EQ(result.summary.approximate_fov, 0);
}

// Signs of known width make the map metric, to what is said of it, and the map remembers that.
TEST_F(Sessions, SignsOfKnownWidthMakeTheMapMetric) {
  const std::vector<TrueSign> signs = read_true_signs(path("first"), {}, {});
  RunOptions options = options_for("first", "out_metric");
  options.save_map = path("metric.db");
  for (const TrueSign& sign : signs)
    options.lengths.push_back({sign.word, "", (sign.corners[1] - sign.corners[0]).norm(), 1e-3});
  const RunResult result = run(options);
  ASSERT_EQ(result.error, "");
  ASSERT_TRUE(result.summary.metric.has_value());
  EXPECT_GE(result.summary.metric->texts, 3);
  const double error = std::abs(result.summary.trajectory.alignment.scale - 1);
  EXPECT_LT(error, 4 * result.summary.metric->sigma);
  EXPECT_LT(error, 0.02);
  EXPECT_EQ(load_map(options.save_map, options.parameters).record.scale_sigma, result.summary.metric->sigma);

  options.lengths = {{"NO SUCH WORD", "", 1, 0.01}};
  options.last = 60;
  EXPECT_NE(run(options).error.find("NO SUCH WORD"), std::string::npos);
}

// What was computed is not lost where the map cannot be saved: another session was saved meanwhile.
TEST_F(Sessions, AMapThatCannotBeSavedIsInTheOutputFolder) {
  RunOptions options = options_for("second", "out_refused");
  options.map = copy_of_map("raced.db");
  options.last = 30;
  options.own_detector = nullptr;
  const LoadedMap other = load_map(options.map, options.parameters);
  struct Race : TextDetector {
    Race(const LoadedMap& map, std::string file) : other(map), path(std::move(file)) {}
    std::vector<Detection> detect(const FrameRef&, ImageView8) override {
      if (!saved) save_map(path, other.map, other.record);
      saved = true;
      return {};
    }
    const LoadedMap& other;
    std::string path;
    bool saved = false;
  };
  options.own_detector = std::make_shared<Race>(other, options.map);
  try {
    run(options);
    FAIL() << "it replaced what the other session saved";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("out_refused/map.db"), std::string::npos) << error.what();
  }
  EXPECT_EQ(load_map(options.map, options.parameters).record.revision, 2);
  EXPECT_EQ(load_map(path("out_refused/map.db"), options.parameters).record.sessions.size(), 2u);
}

}  // namespace
}  // namespace textslam
