// A video's frames reach a detector in colour where it wants that, whichever thread it runs on.
#include <gtest/gtest.h>

#include <memory>

#include "io/io_support.hpp"
#include "plugins/plugins.hpp"
#include "textslam/run.hpp"

namespace textslam {
namespace colour_test {

constexpr int kFrames = 12;

// Frame i is grey at level 100, and has the colour (10 + i, 20 + i, 30 + i).
class Film final : public VideoFile {
 public:
  Film() {
    for (int i = 0; i < kFrames; ++i) times_.push_back(0.01 * i);
  }
  const std::vector<double>& times() const override { return times_; }
  Image<std::uint8_t> load(std::size_t) override { return Image<std::uint8_t>(64, 48, 100); }
  Image<std::uint8_t> load_colour(std::size_t index) override {
    Image<std::uint8_t> image(3 * 64, 48, 0);
    for (int y = 0; y < 48; ++y)
      for (int x = 0; x < 3 * 64; ++x)
        image(x, y) = static_cast<std::uint8_t>(10 * (1 + x % 3) + static_cast<int>(index));
    return image;
  }
  std::size_t damaged() const override { return 0; }

 private:
  std::vector<double> times_;
};
std::unique_ptr<VideoFile> open_film(const std::string&) { return std::make_unique<Film>(); }

// Notes what it sees of each frame.
class Witness final : public TextDetector {
 public:
  explicit Witness(bool colour) : colour_(colour) {}
  bool wants_colour() const override { return colour_; }
  std::vector<Detection> detect(const FrameRef& frame, ImageView8 raw_image) override {
    EXPECT_EQ(raw_image(5, 5), 100);
    ++frames;
    EXPECT_EQ(frame.colour.width(), colour_ ? 3 * raw_image.width() : 0);
    EXPECT_EQ(frame.colour.height(), colour_ ? raw_image.height() : 0);
    for (int channel = 0; colour_ && channel < 3; ++channel)
      EXPECT_EQ(frame.colour(3 * 63 + channel, 47), 10 * (1 + channel) + std::stoi(frame.stem));
    return {};
  }
  int frames = 0;

 private:
  bool colour_;
};

TEST(Colour, OfAVideoReachesTheDetector) {
  const TemporaryFolder folder;
  register_video(open_film);
  for (const bool real_time : {false, true})
    for (const bool colour : {false, true}) {
      const auto witness = std::make_shared<Witness>(colour);
      RunOptions options;
      options.sequence = folder.write("film", "");
      options.output = folder.path("out");
      options.input.fov = 60;
      options.report = false;
      options.own_detector = witness;
      options.parameters.real_time = real_time;
      run(options);
      EXPECT_GT(witness->frames, 0);
      EXPECT_TRUE(real_time || witness->frames == kFrames);
    }
  register_video(nullptr);
  register_plugins();
}

}  // namespace colour_test
}  // namespace textslam
