#include "io/evaluate_detections.hpp"

#include "io/io_support.hpp"

namespace textslam {
namespace io_evaluate_detections_test {

Quad<double> box(double x, double y, double width, double height) {
  Quad<double> quad;
  quad.corner = {Vector2<double>(x, y), Vector2<double>(x + width, y), Vector2<double>(x + width, y + height),
                 Vector2<double>(x, y + height)};
  return quad;
}
Detection found(const Quad<double>& quad) {
  Detection detection;
  detection.quad = quad;
  return detection;
}

TEST(EvaluateDetections, PairsByOverlapAndPassesOverWhatDoesNotCount) {
  const std::vector<TrueText> truth = {
      {box(0, 0, 40, 20), true}, {box(100, 0, 40, 20), true}, {box(200, 0, 40, 20), false}};
  DetectionCounts counts;
  count_detections(truth,
                   {found(box(2, 0, 40, 20)), found(box(0, 1, 40, 20)),  // both on the first: one of them is too many
                    found(box(100, 0, 19, 20)),                          // IoU 0.475
                    found(box(205, 0, 10, 10)),                          // on what does not count
                    found(box(300, 0, 40, 20))},
                   &counts);
  EXPECT_EQ(counts.frames, 1);
  EXPECT_EQ(counts.texts, 2);
  EXPECT_EQ(counts.found, 1);
  EXPECT_EQ(counts.boxes, 4);
  count_detections(truth, {found(box(100, 0, 21, 20))}, &counts);  // IoU 0.525
  EXPECT_EQ(format_counts(counts), "2 frames, 4 texts, 2 found, 5 boxes: recall 0.500, precision 0.400");
}

TEST(EvaluateDetections, NothingIsNoDivision) {
  DetectionCounts counts;
  count_detections({}, {}, &counts);
  EXPECT_EQ(counts.recall(), 0);
  EXPECT_EQ(counts.precision(), 0);
}

TEST(EvaluateDetections, ReadsTheTruthOfRenderedFramesAndOfIcdar) {
  const TemporaryFolder folder;
  Sequence sequence;
  sequence.folder = folder.path();
  FrameRef frame;
  frame.path = folder.path("images/7.png");
  frame.stem = "7";
  expect_input_error([&] { read_true_texts(sequence, frame); }, frame.path, 0, "has no truth");

  folder.write("images/gt_7.txt", "0,0,40,0,40,20,0,20,WORD\n0,0,40,0,40,20,0,20,###\n");
  std::vector<TrueText> truth = read_true_texts(sequence, frame);
  ASSERT_EQ(truth.size(), 2u);
  EXPECT_TRUE(truth[0].counts);
  EXPECT_FALSE(truth[1].counts);
  EXPECT_EQ(truth[0].quad.corner[2], Vector2<double>(40, 20));

  folder.write("truth/quads/7.txt",
               "0,0,40,0,40,20,0,20,A,B,3,1\n0,0,40,0,40,20,0,20,CUT,4,0.5\n0,0,40,0,40,9,0,9,LOW,5,1\n");
  truth = read_true_texts(sequence, frame);
  ASSERT_EQ(truth.size(), 3u);
  EXPECT_TRUE(truth[0].counts);
  EXPECT_FALSE(truth[1].counts);
  EXPECT_FALSE(truth[2].counts);
  folder.write("truth/quads/7.txt", "0,0,40,0,40,20,0,20,WORD,1,often\n");
  expect_input_error([&] { read_true_texts(sequence, frame); }, folder.path("truth/quads/7.txt"), 0,
                     "text,sign,visible");
}

}  // namespace io_evaluate_detections_test
}  // namespace textslam
