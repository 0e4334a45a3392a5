// The first program of docs/integrate.md with a stand-in for the tracker: tests/integrate_page.cmake.
#include <gtest/gtest.h>

#include "integrate.hpp"
#include "landmarks/text_map_support.hpp"

namespace text_map_test {
namespace {

// A tracker by points, which are half a pixel off. Its key frames are where its poses are until it adjusts them.
class StandIn {
 public:
  struct Frame {
    SE3d truth;
    Pyramid image;
    std::vector<TextPoint> points;
    std::vector<TextDetection> quads;
    bool is_key_frame = false;
  };
  StandIn(std::vector<Frame> frames, const textplane::Pinhole<double>& camera)
      : frames_(std::move(frames)), camera_(camera) {}

  bool next() { return ++now_ < static_cast<int>(frames_.size()); }
  textplane::ImageView8 image() const { return frame().image.level(0); }
  void track() {
    std::vector<textplane::PosePointTerm> terms;
    for (const TextPoint& point : frame().points) terms.push_back({point.p_w, point.px, point.sigma});
    const int n = static_cast<int>(terms.size());
    textplane::PoseWorkspace workspace;
    workspace.reserve(nullptr, 0, n);
    T_c_w_ = textplane::refine_pose(nullptr, 0, terms.data(), n, frame().image, camera_, off() * frame().truth, {},
                                    workspace, nullptr, nullptr)
                 .T_t_w;
  }
  SE3d T_c_w() const { return T_c_w_; }
  void set_pose(const SE3d& T_c_w) {
    ++refined_;
    by_points_ += shift(T_c_w_, frame().truth);
    with_texts_ += shift(T_c_w, frame().truth);
    T_c_w_ = T_c_w;
  }
  std::vector<TextPoint> points() const { return frame().points; }
  std::vector<TextDetection> detections() const { return frame().quads; }
  bool wants_key_frame() const { return frame().is_key_frame; }
  int make_key_frame() {
    key_frames_.push_back(T_c_w_);
    truths_.push_back(frame().truth);
    return static_cast<int>(key_frames_.size()) - 1;
  }
  void adjust() { key_frames_ = truths_; }
  SE3d T_c_w_of(int id) const { return key_frames_[static_cast<std::size_t>(id)]; }

  int refined() const { return refined_; }
  double by_points() const { return by_points_; }
  double with_texts() const { return with_texts_; }
  int key_frames() const { return static_cast<int>(key_frames_.size()); }

 private:
  const Frame& frame() const { return frames_[static_cast<std::size_t>(now_)]; }
  static SE3d off() {
    Vec6 xi;
    xi << 0.004, -0.003, 0.002, 0.001, -0.001, 0.002;
    return textplane::se3_exp<double>(xi);
  }

  std::vector<Frame> frames_;
  textplane::Pinhole<double> camera_;
  std::vector<SE3d> key_frames_, truths_;
  SE3d T_c_w_;
  int now_ = -1, refined_ = 0;
  double by_points_ = 0, with_texts_ = 0;  // m, sums over the frames that were refined
};

TEST_F(TextMapTest, TheProgramOfThePageMapsTextsAndRefinesPoses) {
  std::vector<StandIn::Frame> frames;
  for (int i = 0; i < 12; ++i) {
    const SE3d truth = pose(i < 8 ? i : i - 4.5);
    frames.push_back({truth, image(truth), points(truth, 0.5, static_cast<unsigned>(i)), quads(truth), i < 8});
  }
  StandIn tracker(std::move(frames), scene.camera);
  TextMap texts(scene.camera);
  run(tracker, texts);
  EXPECT_EQ(mapped(texts), 3);
  EXPECT_LT(largest_angle(texts), 1.5) << "degrees";
  EXPECT_GE(tracker.refined(), 4);
  EXPECT_LT(tracker.with_texts(), 0.7 * tracker.by_points()) << "m";
  ASSERT_EQ(tracker.key_frames(), 8);
  for (int id = 0; id < 8; ++id)
    EXPECT_LT(shift(texts.keyframes().text_keyframe(id).T_c_w(), tracker.T_c_w_of(id)), 1e-12) << id;
}

}  // namespace
}  // namespace text_map_test
