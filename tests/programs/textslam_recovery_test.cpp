// Sequences in which the camera is taken elsewhere in the dark: the program comes back into its map, joins maps of one
// room, and says so where parts of a sequence have nothing to do with each other.
#include <cmath>
#include <nlohmann/json.hpp>

#include "io/evaluate.hpp"
#include "io/image_file.hpp"
#include "programs/textslam_support.hpp"
#include "support/long_test.hpp"

namespace textslam {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr int kWidth = 320, kHeight = 240;

std::string stem(int frame) {
  const std::string digits = std::to_string(frame);
  return std::string(6 - digits.size(), '0') + digits;
}

// Sequences put together from frames of two rendered rooms and of a corridor (number 3), made when first asked for.
class TextslamRecovery : public testing::Test {
 protected:
  static void SetUpTestSuite() { rooms_ = new TemporaryFolder; }
  static void TearDownTestSuite() { delete rooms_; }
  static std::string room(int seed) {
    RenderOptions options;
    options.kind = seed == 3 ? "corridor" : "room";
    options.output = rooms_->path("room" + std::to_string(seed));
    options.seed = seed == 3 ? 1 : static_cast<std::uint64_t>(seed);
    options.frames = seed == 1 ? 121 : seed == 2 ? 45 : 161;
    options.width = kWidth;
    options.height = kHeight;
    if (!fs::exists(options.output)) render_sequence(options);
    return options.output;
  }

  TextslamRecovery() {
    fs::create_directories(folder_.path("seq/images"));
    fs::create_directories(folder_.path("seq/detections"));
    fs::copy(room(1) + "/camera.yaml", folder_.path("seq/camera.yaml"));
  }
  // Frames `first` to `last` of a room, backwards where last < first.
  void append(int seed, int first, int last) {
    const std::vector<StampedPose> truth = read_tum(room(seed) + "/groundtruth.txt");
    for (int i = first; first <= last ? i <= last : i >= last; i += first <= last ? 1 : -1) {
      fs::copy(room(seed) + "/images/" + stem(i) + ".png", folder_.path("seq/images/" + stem(frames_) + ".png"));
      fs::copy(room(seed) + "/detections/" + stem(i) + ".txt",
               folder_.path("seq/detections/" + stem(frames_) + ".txt"));
      truth_.push_back({time(frames_), truth[static_cast<std::size_t>(i)].T_w_c});
      ++frames_;
    }
  }
  void append_dark(int count) {
    const std::string dark = encode_png(Image<std::uint8_t>(kWidth, kHeight, 0).view());
    for (int i = 0; i < count; ++i) folder_.write("seq/images/" + stem(frames_++) + ".png", dark);
  }
  ProgramResult run(std::vector<std::string> more = {}) {
    std::string list;
    for (int i = 0; i < frames_; ++i) list += std::to_string(time(i)) + " images/" + stem(i) + ".png\n";
    folder_.write("seq/images.txt", list);
    folder_.write("seq/groundtruth.txt", format_tum(truth_));
    more.insert(more.begin(), {folder_.path("seq"), "--output", folder_.path("out")});
    return textslam_program(more);
  }
  Json metrics() const { return Json::parse(bytes_of(folder_.path("out/metrics.json"))); }
  std::vector<StampedPose> trajectory() const { return read_tum(folder_.path("out/trajectory.txt")); }
  // Frames first, ..., last of the sequence that have a pose.
  int tracked(int first, int last) const {
    int count = 0;
    for (const StampedPose& pose : trajectory())
      count += pose.timestamp > time(first) - 1e-3 && pose.timestamp < time(last) + 1e-3 ? 1 : 0;
    return count;
  }
  double ate() const { return metrics().at("trajectory").at("ate_rmse").get<double>(); }

  static double time(int frame) { return frame / 30.0; }

  static TemporaryFolder* rooms_;
  TemporaryFolder folder_;
  std::vector<StampedPose> truth_;
  int frames_ = 0;
};
TemporaryFolder* TextslamRecovery::rooms_ = nullptr;

TEST_F(TextslamRecovery, ComesBackIntoItsMap) {
  append(1, 0, 49);
  append_dark(8);
  append(1, 120, 71);
  expect_success(run());
  EXPECT_EQ(metrics().at("maps"), 1);
  EXPECT_EQ(metrics().at("map_frames"), Json::array({metrics().at("tracked")}));
  EXPECT_GE(tracked(0, 49), 48);
  EXPECT_EQ(tracked(50, 57), 0);
  EXPECT_GE(tracked(58, 107), 48);
  const double with_gap = ate();

  // The same places without the jump.
  fs::remove_all(folder_.path("seq/images"));
  fs::remove_all(folder_.path("seq/detections"));
  fs::create_directories(folder_.path("seq/images"));
  fs::create_directories(folder_.path("seq/detections"));
  truth_.clear();
  frames_ = 0;
  append(1, 0, 120);
  expect_success(run());
  EXPECT_LE(with_gap, 2 * ate());
}

// Far down the corridor nothing of the first map can be seen, and a second one begins; on its way back the camera meets
// the first.
TEST_F(TextslamRecovery, MapsOfOneCorridorBecomeOne) {
  TEXTPLANE_LONG_TEST();
  append(3, 0, 44);
  append_dark(32);
  append(3, 160, 20);
  expect_success(run({"--mode", "points"}));
  EXPECT_EQ(metrics().at("maps"), 1);
  EXPECT_GE(tracked(77, 217), 134) << "the frames of the second map are in the first one's world";
  EXPECT_LT(ate(), 0.005 * metrics().at("trajectory").at("path_length").get<double>());
  // It did begin: some key frames were no part of the first map when they came.
  const std::vector<double> live = times_of(read_tum(folder_.path("out/trajectory_live.txt")));
  int joined = 0;
  for (const double t : times_of(read_tum(folder_.path("out/keyframes.txt"))))
    joined += t > time(77) - 1e-3 && std::find(live.begin(), live.end(), t) == live.end() ? 1 : 0;
  EXPECT_GE(joined, 2);
}

TEST_F(TextslamRecovery, AnotherRoomIsAnotherMap) {
  TEXTPLANE_LONG_TEST();
  append(1, 0, 49);
  append_dark(32);
  append(2, 0, 44);
  const ProgramResult result = run();
  EXPECT_EQ(result.code, 0);
  EXPECT_EQ(result.err.find("textslam: warning: 2 separate maps"), 0u) << result.err;
  const Json m = metrics();
  EXPECT_EQ(m.at("maps"), 2);
  ASSERT_EQ(m.at("map_frames").size(), 2u);
  EXPECT_GE(m.at("map_frames").at(0).get<int>(), 48);
  EXPECT_GE(m.at("map_frames").at(1).get<int>(), 30);
  EXPECT_EQ(m.at("tracked"), m.at("map_frames").at(0)) << "the outputs hold the larger one";
  EXPECT_EQ(tracked(82, 126), 0);
  EXPECT_EQ(tracked(0, 49), m.at("tracked").get<int>());
  EXPECT_LE(read_tum(folder_.path("out/keyframes.txt")).back().timestamp, time(49) + 1e-3);
  EXPECT_LE(read_tum(folder_.path("out/trajectory_live.txt")).back().timestamp, time(49) + 1e-3);
  EXPECT_LT(ate(), 0.005 * m.at("trajectory").at("path_length").get<double>());
}

}  // namespace
}  // namespace textslam
