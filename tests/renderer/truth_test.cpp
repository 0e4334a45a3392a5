// The files of a rendered sequence agree with each other: signs, poses and camera read back give the quads, and the
// words stand where the signs say.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>

#include "io/io_support.hpp"
#include "io/text_file.hpp"
#include "renderer/kinds.hpp"
#include "renderer/ray_caster.hpp"
#include "renderer/render_sequence.hpp"
#include "renderer/renderer_support.hpp"
#include "renderer/sign_plate.hpp"
#include "renderer/truth.hpp"

namespace textslam {
namespace renderer_truth_test {

RenderOptions small(const std::string& kind, const std::string& output, int frames) {
  RenderOptions options;
  options.kind = kind;
  options.output = output;
  options.frames = frames;
  options.width = 160;
  options.height = 120;
  return options;
}

struct TruthQuad {
  int sign;
  std::string word;
  double visible;
  Vector2<double> corner[4];
};

std::vector<TruthQuad> read_truth_quads(const std::string& path) {
  std::vector<TruthQuad> quads;
  for (const TextLine& line : read_lines(path)) {
    std::vector<std::string> column(1);
    for (const char c : line.text) {
      if (c == ',') {
        column.emplace_back();
      } else {
        column.back().push_back(c);
      }
    }
    EXPECT_EQ(column.size(), 11u) << line.text;
    TruthQuad quad{std::stoi(column.at(9)), column.at(8), std::stod(column.at(10)), {}};
    for (std::size_t k = 0; k < 4; ++k) quad.corner[k] = {std::stod(column[2 * k]), std::stod(column[2 * k + 1])};
    quads.push_back(quad);
  }
  return quads;
}

void expect_quads_are_projected_signs(const RenderOptions& options) {
  render_sequence(options);
  const Sequence sequence = read_sequence(options.output);
  ASSERT_EQ(static_cast<int>(sequence.frames.size()), options.frames);
  ASSERT_EQ(sequence.groundtruth.size(), sequence.frames.size());
  EXPECT_TRUE(sequence.has_detections);
  std::ifstream in(options.output + "/truth/signs.json");
  const nlohmann::json signs = nlohmann::json::parse(in).at("signs");
  ASSERT_GT(signs.size(), 5u);
  double worst = 0.0;
  int compared = 0;
  for (std::size_t i = 0; i < sequence.frames.size(); ++i) {
    EXPECT_EQ(sequence.groundtruth[i].timestamp, sequence.frames[i].timestamp);
    const SE3d T_c_w = sequence.groundtruth[i].T_w_c.inverse();
    for (const TruthQuad& quad :
         read_truth_quads(options.output + "/truth/quads/" + sequence.frames[i].stem + ".txt")) {
      const nlohmann::json& sign = signs.at(static_cast<std::size_t>(quad.sign));
      EXPECT_EQ(sign.at("id"), quad.sign);
      EXPECT_EQ(sign.at("text"), quad.word);
      EXPECT_GT(quad.visible, 0.0);
      EXPECT_LE(quad.visible, 1.0);
      const auto vector = [](const nlohmann::json& v) { return Vector3<double>(v.at(0), v.at(1), v.at(2)); };
      const Vector3<double> normal = vector(sign.at("normal"));
      for (std::size_t k = 0; k < 4; ++k) {
        const Vector3<double> p_w = vector(sign.at("corners").at(k)), p = T_c_w * p_w;
        EXPECT_NEAR(normal.dot(p_w - vector(sign.at("corners").at(0))), 0.0, 1e-12);
        const Vector2<double> px = sequence.camera.project(p);
        worst = std::max(worst, (px - quad.corner[k]).cwiseAbs().maxCoeff());
        ++compared;
      }
    }
  }
  EXPECT_GT(compared, 4 * options.frames);
  EXPECT_LT(worst, 1e-6);
}

RenderOptions at_full_size(RenderOptions options) {
  options.width = 640;
  options.height = 480;
  return options;
}

TEST(RendererTruth, SignsPosesAndCameraReadBackGiveTheQuads) {
  const TemporaryFolder folder;
  expect_quads_are_projected_signs(at_full_size(small("sparse", folder.path("a"), 12)));
}

TEST(RendererTruth, TheSameThroughALens) {
  const TemporaryFolder folder;
  RenderOptions options = small("sparse", folder.path("a"), 12);
  options.lens = test_lens();
  expect_quads_are_projected_signs(options);
}

TEST(RendererTruth, TheSameThroughAFisheye) {
  const TemporaryFolder folder;
  expect_quads_are_projected_signs(at_full_size(small("fisheye", folder.path("a"), 4)));
}

TEST(RendererTruth, TheWordStandsInItsBox) {
  const std::vector<Font> fonts = load_fonts();
  Random random(3);
  for (const std::string& word : sign_words(24, random)) {
    const SignPlate plate = make_sign_plate(word, 0.6, fonts, random);
    const Image<float>& pixels = plate.paint.pixels();
    const Vector2<double> d = plate.paint.density();
    const double rim = 0.06 / 1.12 * plate.text_height;
    // The rim itself is paper: its corner tells the paper's shade. Ink is whatever differs, half a rim around the box.
    const auto texel = [](double metres, double density) { return static_cast<int>(metres * density); };
    const double paper = static_cast<double>(pixels(texel(plate.text_x, d[0]), texel(plate.text_y, d[1])));
    int left = pixels.width(), right = -1, top = pixels.height(), bottom = -1;
    for (int y = texel(plate.text_y - 0.5 * rim, d[1]); y < texel(plate.text_y + plate.text_height + 0.5 * rim, d[1]);
         ++y) {
      for (int x = texel(plate.text_x - 0.5 * rim, d[0]); x < texel(plate.text_x + plate.text_width + 0.5 * rim, d[0]);
           ++x) {
        if (std::abs(static_cast<double>(pixels(x, y)) - paper) < 45.0) continue;
        left = std::min(left, x);
        right = std::max(right, x);
        top = std::min(top, y);
        bottom = std::max(bottom, y);
      }
    }
    EXPECT_NEAR(left / d[0], plate.text_x + rim, 0.003) << word;
    EXPECT_NEAR((right + 1) / d[0], plate.text_x + plate.text_width - rim, 0.003) << word;
    EXPECT_NEAR(top / d[1], plate.text_y + rim, 0.003) << word;
    EXPECT_NEAR((bottom + 1) / d[1], plate.text_y + plate.text_height - rim, 0.003) << word;
  }
}

TEST(RendererTruth, SignsAreClockwiseFromTheTextsTopLeftAndFaceTheirReader) {
  const Shot shot = make_shot("sparse", 4, 640, 480);
  const CameraModel camera = test_camera();
  for (const SignView& view : views_of_signs(shot.scene, camera, shot.motion(1.0))) {
    EXPECT_GT(textplane::area(view.quad), 0.0);
    EXPECT_LT(view.quad.corner[0][0], view.quad.corner[1][0]);
    EXPECT_LT(view.quad.corner[0][1], view.quad.corner[3][1]);
    EXPECT_GT(view.cosine, 0.0);
  }
}

TEST(RendererTruth, WhatIsHiddenOrOutOfViewIsNotVisible) {
  const CameraModel camera = test_camera();
  SE3d T_w_c;
  T_w_c.R << 1, 0, 0, 0, 0, 1, 0, -1, 0;
  const auto visible = [&](const Vector3<double>& centre, double towards_y, const Rectangle* screen) {
    Scene scene;
    const Rectangle r = facing(centre, {0.0, towards_y, 0.0}, 0.4, 0.2);
    scene.add_unlit(r, Image<std::uint8_t>(2, 2, 200));
    scene.add_sign("EXIT", r);
    if (screen) scene.add_unlit(*screen, Image<std::uint8_t>(2, 2, 100));
    const std::vector<SignView> views = views_of_signs(scene, camera, T_w_c);
    return views.empty() ? 0.0 : views.front().visible;
  };
  EXPECT_EQ(visible({0.0, 2.0, 0.0}, -1.0, nullptr), 1.0);
  EXPECT_EQ(visible({0.0, 2.0, 0.0}, 1.0, nullptr), 0.0) << "from behind";
  EXPECT_EQ(visible({0.0, -2.0, 0.0}, 1.0, nullptr), 0.0) << "behind the camera";
  EXPECT_EQ(visible({3.0, 2.0, 0.0}, -1.0, nullptr), 0.0) << "out of view";
  EXPECT_NEAR(visible({2.0 * 319.5 / 525.0, 2.0, 0.0}, -1.0, nullptr), 0.5, 0.04) << "half out of view";
  const Rectangle left_half = facing({-0.25, 1.0, 0.0}, {0.0, -1.0, 0.0}, 0.5, 0.5);
  EXPECT_NEAR(visible({0.0, 2.0, 0.0}, -1.0, &left_half), 0.5, 1e-12);
  const Rectangle behind = facing({0.0, 2.5, 0.0}, {0.0, -1.0, 0.0}, 3.0, 3.0);
  EXPECT_EQ(visible({0.0, 2.0, 0.0}, -1.0, &behind), 1.0);
}

std::map<std::string, std::string> bytes_of(const std::string& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file()) continue;
    files[std::filesystem::relative(entry.path(), folder).string()] = read_file(entry.path().string());
  }
  return files;
}

TEST(RendererSequence, TheSameSeedGivesTheSameBytesOnAnyNumberOfThreads) {
  const TemporaryFolder folder;
  std::vector<std::map<std::string, std::string>> runs;
  for (const int threads : {1, 2, 3}) {
    RenderOptions options = small("sparse", folder.path(std::to_string(threads)), 7);
    options.threads = threads;
    std::vector<int> calls;
    render_sequence(options, [&calls](int done, int total) {
      EXPECT_EQ(total, 7);
      calls.push_back(done);
    });
    EXPECT_EQ(calls, (std::vector<int>{1, 2, 3, 4, 5, 6, 7}));
    runs.push_back(bytes_of(options.output));
  }
  EXPECT_EQ(runs[0].size(), 5u + 3u * 7u);
  EXPECT_TRUE(runs[0] == runs[1]);
  EXPECT_TRUE(runs[0] == runs[2]);

  RenderOptions other = small("sparse", folder.path("other"), 7);
  other.seed = 2;
  render_sequence(other);
  const std::map<std::string, std::string> changed = bytes_of(other.output);
  for (const char* name : {"images/000003.png", "groundtruth.txt", "truth/signs.json", "truth/quads/000003.txt"}) {
    EXPECT_NE(changed.at(name), runs[0].at(name)) << name;
  }
}

TEST(RendererSequence, WithoutTextThereAreNoDetections) {
  const TemporaryFolder folder;
  const RenderOptions options = small("notext", folder.path("a"), 6);
  render_sequence(options);
  const Sequence sequence = read_sequence(options.output);
  for (const FrameRef& frame : sequence.frames) {
    EXPECT_TRUE(read_detections(sequence, frame).empty());
    EXPECT_TRUE(read_truth_quads(options.output + "/truth/quads/" + frame.stem + ".txt").empty());
  }
  EXPECT_EQ(load_frame(sequence, 5).width(), 160);
}

TEST(RendererSequence, RefusesWhatItCannotRender) {
  const TemporaryFolder folder;
  try {
    render_sequence(small("ballroom", folder.path("a"), 1));
    ADD_FAILURE() << "an unknown kind must be refused";
  } catch (const InputError& error) {
    for (const std::string& kind : render_kinds()) EXPECT_NE(error.message().find(kind), std::string::npos) << kind;
    EXPECT_NE(std::string(error.what()).find("ballroom"), std::string::npos);
  }
  EXPECT_FALSE(std::filesystem::exists(folder.path("a"))) << "nothing is made for an unknown kind";
  EXPECT_THROW(render_sequence(small("room", "", 1)), InputError);
  EXPECT_THROW(render_sequence(small("room", folder.path("b"), -1)), InputError);
  RenderOptions tiny = small("room", folder.path("b"), 1);
  tiny.width = 10;
  EXPECT_THROW(render_sequence(tiny), InputError);
  const std::vector<std::string> kinds = render_kinds();
  for (const char* kind :
       {"room", "room-still", "corridor", "rapid", "lights", "night", "sparse", "notext", "loop", "standoff",
        "cylinders", "glass", "crowd", "moving", "cuts", "covered", "wide", "fisheye", "shutter"}) {
    EXPECT_EQ(std::count(kinds.begin(), kinds.end(), kind), 1) << kind;
  }
}

TEST(RendererFont, AMissingFontIsAnErrorThatNamesThePackage) {
  const TemporaryFolder folder;
  folder.write("broken.ttf", "no font at all");
  try {
    load_fonts({folder.path()});
    ADD_FAILURE();
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("fonts-dejavu-core"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find(folder.path()), std::string::npos);
  }
  EXPECT_THROW(Font(folder.path("broken.ttf")), std::runtime_error);
  EXPECT_THROW(Font(folder.path("absent.ttf")), std::runtime_error);
}

TEST(RendererFont, InkIsCroppedAndAsHighAsItsCapitals) {
  const Font font = std::move(load_fonts().front());
  const Ink ink = font.draw("HH", 80.0);
  EXPECT_NEAR(ink.height(), 80, 1.01);
  const Ink wide = font.draw("HHHH", 80.0);
  EXPECT_GT(wide.width(), 19 * ink.width() / 10);
  const auto inked = [&](int x0, int x1, int y0, int y1) {
    for (int y = y0; y < y1; ++y) {
      for (int x = x0; x < x1; ++x) {
        if (ink(x, y) > 0) return true;
      }
    }
    return false;
  };
  EXPECT_TRUE(inked(0, 1, 0, ink.height()) && inked(ink.width() - 1, ink.width(), 0, ink.height()));
  EXPECT_TRUE(inked(0, ink.width(), 0, 1) && inked(0, ink.width(), ink.height() - 1, ink.height()));
  EXPECT_TRUE(font.draw("", 80.0).empty());
}

}  // namespace renderer_truth_test
}  // namespace textslam
