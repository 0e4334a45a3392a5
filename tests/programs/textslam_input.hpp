// A sequence of one's own for the program: flat grey images, or the first frames of a rendered room, and what to expect
// of its run.
#ifndef TESTS_PROGRAMS_TEXTSLAM_INPUT_HPP
#define TESTS_PROGRAMS_TEXTSLAM_INPUT_HPP

#include <nlohmann/json.hpp>

#include "io/evaluate.hpp"
#include "io/image_file.hpp"
#include "programs/textslam_support.hpp"
#include "renderer/renderer_support.hpp"

namespace textslam {

namespace fs = std::filesystem;
using Json = nlohmann::json;

inline std::string image_name(int frame) {
  std::string digits = std::to_string(frame);
  return "images/" + std::string(6 - digits.size(), '0') + digits + ".png";
}

inline bool says(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

// A folder with a sequence `sequence` and room for the results.
class TextslamInput : public testing::Test {
 protected:
  // Flat grey images at 30 a second.
  void make_flat(int frames, int width = 64) {
    std::string list;
    for (int i = 0; i < frames; ++i) {
      write(image_name(i), encode_png(Image<std::uint8_t>(width, width * 3 / 4, 100).view()));
      list += std::to_string(i / 30.0) + " " + image_name(i) + "\n";
    }
    write("images.txt", list);
    write("camera.yaml", format_camera(test_camera(width)));
  }
  // The first frames of the room, small; rendered once for all tests.
  void make_room() {
    static const TemporaryFolder rendered;
    if (!fs::exists(rendered.path("room"))) render(rendered.path("room"), "room", kFrames, 320);
    fs::copy(rendered.path("room"), sequence(), fs::copy_options::recursive);
  }

  std::string line_of(int frame) const {
    const int line = read_sequence(sequence()).frames[static_cast<std::size_t>(frame)].line;
    return sequence("images.txt") + ":" + std::to_string(line) + ": ";
  }
  std::string sequence(const std::string& name = "") const {
    return folder_.path(name.empty() ? "seq" : "seq/" + name);
  }
  std::string output(const std::string& name = "") const { return folder_.path(name.empty() ? "out" : "out/" + name); }
  void write(const std::string& name, const std::string& bytes) const { folder_.write("seq/" + name, bytes); }
  void replace(const std::string& name, const std::string& from, const std::string& to) const {
    std::string text = bytes_of(sequence(name));
    const std::size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from << " in " << name;
    write(name, text.replace(at, from.size(), to));
  }
  ProgramResult run(std::vector<std::string> more = {}) const {
    more.insert(more.begin(), {sequence(), "--output", output()});
    return textslam_program(more);
  }
  Json metrics() const { return Json::parse(bytes_of(output("metrics.json"))); }

  // The run ends at frame `broken`: everything before it is written, the same as if the sequence had ended there.
  void expect_kept_before(int broken) {
    expect_all_outputs(output());
    const ProgramResult shorter =
        textslam_program({sequence(), "--output", folder_.path("shorter"), "--last", std::to_string(broken - 1)});
    EXPECT_EQ(shorter.code, 0) << shorter.err;
    for (const char* name :
         {"trajectory.txt", "trajectory_live.txt", "keyframes.txt", "covariances.csv", "text_map.json", "text_map.ply"})
      EXPECT_EQ(bytes_of(output(name)), bytes_of(folder_.path("shorter") + "/" + name)) << name;
    EXPECT_EQ(read_tum(output("trajectory.txt")).size(), static_cast<std::size_t>(broken));
    EXPECT_EQ(metrics().at("frames"), kFrames) << "coverage counts the frames asked for";
    EXPECT_EQ(metrics().at("tracked"), broken);
  }

  static constexpr int kFrames = 24;
  TemporaryFolder folder_;
};

}  // namespace textslam

#endif  // TESTS_PROGRAMS_TEXTSLAM_INPUT_HPP
