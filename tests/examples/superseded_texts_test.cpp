// A detector that first boxes whole pages, and later the lines on them: the lines take the place of the pages.
#include <gtest/gtest.h>

#include <memory>

#include "examples/io_support.hpp"
#include "io/image_file.hpp"
#include "renderer/render_sequence.hpp"
#include "textslam/system.hpp"

namespace textslam {
namespace superseded_texts_test {

constexpr int kFrames = 200, kPages = 50;

Quad<double> page_round(const Quad<double>& line) {
  const Vec2 centre = textplane::centroid(line);
  Quad<double> page;
  for (std::size_t i = 0; i < 4; ++i) page.corner[i] = centre + 1.8 * (line.corner[i] - centre);
  return page;
}

// Of the last frame's detections, how many a mapped text has the outline of, and how many lie in one that is far larger.
void count_outlines(const Map& map, const SE3d& T_c_w, const std::vector<Detection>& detections, int* lines,
                    int* pages) {
  for (const Detection& detection : detections)
    for (const TextObject& text : map.texts) {
      Quad<double> quad;
      if (text.state != TextState::mapped || !project_text(map, text, T_c_w, &quad)) continue;
      *lines += textplane::iou(quad, detection.quad) > 0.5 ? 1 : 0;
      *pages += textplane::iou(quad, page_round(detection.quad)) > 0.6 ? 1 : 0;
    }
}

TEST(SupersededTexts, LinesTakeThePlaceOfPages) {
  const TemporaryFolder folder;
  RenderOptions options;
  options.output = folder.path("room");
  options.frames = kFrames;
  options.width = 320;
  options.height = 240;
  render_sequence(options);
  const Sequence sequence = read_sequence(options.output);
  for (const bool replaced : {false, true}) {
    Parameters parameters;
    if (!replaced) parameters.text_max_contradictions = 1000;
    System system(sequence.camera.pinhole, sequence.camera.width, sequence.camera.height, parameters);
    std::vector<Detection> last;
    for (int i = 0; i < kFrames; ++i) {
      const auto at = static_cast<std::size_t>(i);
      Frame frame;
      frame.index = i;
      frame.timestamp = sequence.frames[at].timestamp;
      frame.image = std::make_shared<const Pyramid>(load_frame(sequence, at).view(), parameters.pyramid_levels);
      last = frame.detections = read_detections(sequence, sequence.frames[at]);
      if (i < kPages)
        for (Detection& detection : frame.detections) detection.quad = page_round(detection.quad);
      system.process(frame);
    }
    system.finish();
    ASSERT_EQ(system.records().back().state, FrameState::tracked);
    int lines = 0, pages = 0;
    count_outlines(system.map(), system.final_pose(system.records().back()).inverse(), last, &lines, &pages);
    SCOPED_TRACE(testing::Message() << "replaced: " << replaced << ", lines " << lines << ", pages " << pages);
    if (replaced) {
      EXPECT_GE(lines, 2);
      EXPECT_EQ(pages, 0);
    } else {
      EXPECT_GE(pages, 2) << "else there is nothing to replace";
    }
  }
}

}  // namespace superseded_texts_test
}  // namespace textslam
