// The camera walks round a room and comes back: the program closes the loop, says what it found, and leaves it open
// when told.
#include <nlohmann/json.hpp>

#include "programs/textslam_support.hpp"
#include "support/long_test.hpp"

namespace textslam {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

class TextslamLoop : public testing::Test {
 protected:
  static constexpr int kFrames = 320;  // the first wall has come back into view

  static void SetUpTestSuite() { folder_ = new TemporaryFolder; }
  static void TearDownTestSuite() {
    delete closed_;
    delete folder_;
  }
  static ProgramResult run(const std::string& name, std::vector<std::string> more = {}) {
    const std::string sequence = folder_->path("seq");
    if (!fs::exists(sequence)) render(sequence, "loop", kFrames, 320);
    more.insert(more.begin(), {sequence, "--output", folder_->path(name)});
    return textslam_program(more);
  }
  // What the program does by itself: run once for all tests.
  static const ProgramResult& closed() {
    if (!closed_) closed_ = new ProgramResult(run("closed"));
    return *closed_;
  }
  static Json metrics(const std::string& name) { return Json::parse(bytes_of(folder_->path(name + "/metrics.json"))); }

  static TemporaryFolder* folder_;
  static const ProgramResult* closed_;
};
TemporaryFolder* TextslamLoop::folder_ = nullptr;
const ProgramResult* TextslamLoop::closed_ = nullptr;

TEST_F(TextslamLoop, IsClosedAndReported) {
  TEXTPLANE_LONG_TEST();
  const ProgramResult& result = closed();
  expect_success(result);
  EXPECT_NE(result.out.find("loops closed"), std::string::npos) << result.out;
  const Json m = metrics("closed");
  ASSERT_GE(m.at("loops").size(), 1U);
  const Json& loop = m.at("loops").at(0);
  EXPECT_GT(loop.at("frame").get<int>(), 240) << "not before the camera was round";
  EXPECT_LT(loop.at("met_keyframe").get<int>(), 60) << "the beginning";
  EXPECT_TRUE(loop.at("text").is_string());
  const Json &found = loop.at("drift"), &left = loop.at("left");
  EXPECT_LT(found.at("translation_share").get<double>(), 0.02);
  EXPECT_LT(found.at("rotation_deg").get<double>(), 3);
  EXPECT_NEAR(found.at("scale").get<double>(), 1, 0.05);
  for (const char* part : {"translation_share", "rotation_deg"})
    EXPECT_LT(left.at(part).get<double>(), 0.3 * found.at(part).get<double>()) << part;
  EXPECT_NEAR(left.at("scale").get<double>(), 1, 0.005);
  EXPECT_EQ(m.at("tracked"), kFrames);
  EXPECT_EQ(m.at("maps"), 1);
  EXPECT_EQ(m.at("text").at("false_texts"), 0);
  const Json& trajectory = m.at("trajectory");
  EXPECT_LT(trajectory.at("ate_rmse").get<double>(), 0.001 * trajectory.at("path_length").get<double>());
}

TEST_F(TextslamLoop, StaysOpenWhenTold) {
  TEXTPLANE_LONG_TEST();
  const ProgramResult result = run("open", {"--no-loop-closure"});
  expect_success(result);
  EXPECT_EQ(result.out.find("loops closed"), std::string::npos) << result.out;
  const Json m = metrics("open");
  EXPECT_TRUE(m.at("loops").empty());
  EXPECT_EQ(m.at("tracked"), kFrames) << "what was not recognised is mapped anew";
  expect_success(closed());
  const auto ate = [](const Json& of) { return of.at("trajectory").at("ate_rmse").get<double>(); };
  EXPECT_LT(ate(metrics("closed")), 0.8 * ate(m)) << "closing it is worth its while";
}

TEST_F(TextslamLoop, TheSameBytesTwice) {
  TEXTPLANE_LONG_TEST();
  expect_success(closed());
  expect_success(run("twice"));
  for (const char* name : kOutputs)
    EXPECT_TRUE(same_part(folder_->path("closed"), name) == same_part(folder_->path("twice"), name)) << name;
}

}  // namespace
}  // namespace textslam
