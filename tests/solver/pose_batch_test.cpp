// refine_pose() on many small texts: by the batch kernel as by the kernels of one text, which a rig of one camera takes
// them through.
#include "textplane/solver/pose_batch.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "support/targets.hpp"
#include "support/text_wall.hpp"
#include "textplane/solver/pose.hpp"

namespace pose_batch_test {

namespace tp = textplane;

class PoseBatchTest : public testing::Test {
 protected:
  PoseBatchTest() : map_(wall().camera) {
    wall().fill(map_, textplane_test::TextWall::kInView);
    patches_.reserve(map_.objects().size());
    for (const tp::TextObject& text : map_.objects()) patches_.push_back(text.patch);
    for (std::size_t i = 0; i < patches_.size(); ++i)
      terms_.push_back({&patches_[i], map_.objects()[i].theta, tp::SE3d()});
    options_.solve.cost_tolerance = 0;
    options_.solve.step_tolerance = 1e-9;
  }

  static const textplane_test::TextWall& wall() {
    static const textplane_test::TextWall made;
    return made;
  }

  void cut_all(int n) {
    for (tp::TextPatch& patch : patches_) textplane_test::keep_pixels(patch, n);
  }

  int count() const { return static_cast<int>(terms_.size()); }

  tp::PoseFit together(std::vector<float>* zncc = nullptr) {
    tp::PoseWorkspace workspace;
    workspace.reserve(terms_.data(), count(), 0);
    if (zncc) zncc->assign(terms_.size(), 0);
    return tp::refine_pose(terms_.data(), count(), nullptr, 0, wall().frame.view(), wall().camera, wall().start,
                           options_, workspace, zncc ? zncc->data() : nullptr);
  }
  tp::PoseFit one_by_one(std::vector<float>* zncc = nullptr) {
    const tp::PoseCamera camera{wall().camera, tp::SE3d(), wall().frame.view()};
    tp::PoseWorkspace workspace;
    workspace.reserve(terms_.data(), count(), 0);
    if (zncc) zncc->assign(terms_.size(), 0);
    return tp::refine_pose(terms_.data(), count(), nullptr, 0, &camera, 1, wall().start, options_, workspace,
                           zncc ? zncc->data() : nullptr);
  }

  // The same texts and the same pose as far as the costs tell it: a motion xi from the minimum
  // costs xi^T information xi, and sums of N floats err by N 6e-8 (simd/batch.hpp); the least N here is 15.
  static void expect_same(const tp::PoseFit& a, const tp::PoseFit& b) {
    ASSERT_TRUE(is_ok(b.status) || b.status == tp::Status::diverged) << to_string(b.status);
    EXPECT_EQ(a.texts, b.texts);
    EXPECT_EQ(a.visible_pixels, b.visible_pixels);
    EXPECT_NEAR(a.zncc, b.zncc, 1e-5);
    EXPECT_NEAR(a.cost, b.cost, 1e-4 * b.cost);
    const tp::SE3d apart = a.T_t_w * b.T_t_w.inverse();
    tp::Vector6<double> xi;
    xi << apart.t, tp::so3_log<double>(apart.R);
    EXPECT_LT(xi.dot(b.information * xi), 15 * 6e-8 * b.cost);
  }

  tp::TextMap map_;
  std::vector<tp::TextPatch> patches_;
  std::vector<tp::PoseTextTerm> terms_;
  tp::PoseOptions options_;
};

// At one pose, as no step is taken: at poses that differ by next to nothing pixels may lie in other cells.
TEST_F(PoseBatchTest, SumsUpToTheSameInformation) {
  options_.coarsest_level = 0;
  options_.solve.step_tolerance = 1e9;
  for (const int n : {32, 19, 15}) {
    cut_all(n);
    const tp::PoseFit a = together(), b = one_by_one();
    ASSERT_EQ(a.iterations + b.iterations, 0);
    EXPECT_NEAR(a.cost, b.cost, 1e-5 * b.cost);
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j)
        EXPECT_NEAR(a.information(i, j), b.information(i, j),
                    1e-4 * std::sqrt(b.information(i, i) * b.information(j, j)))
            << i << ", " << j;
  }
}

TEST_F(PoseBatchTest, FindsThePoseThatTextsOneByOneFind) {
  for (const tp::simd::Target target : textplane_test::testable_targets()) {
    const textplane_test::TargetScope scope(target);
    SCOPED_TRACE(tp::simd::to_string(target));
    for (const int n : {33, 32, 25, 15}) {
      SCOPED_TRACE(n);
      cut_all(n);
      std::vector<float> a, b;
      const tp::PoseFit fit = together(&a);
      EXPECT_EQ(fit.path, tp::Path::kernel);
      expect_same(fit, one_by_one(&b));
      for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i], b[i], 1e-4F) << i;
      const double error = (fit.T_t_w.inverse().t - wall().T_c_w.inverse().t).norm();
      EXPECT_LT(error, n < 30 ? 0.02 : 0.01) << "m from the truth";
    }
  }
}

// What the batch does not take goes one by one, beside it.
TEST_F(PoseBatchTest, TextsOfAllSortsKeepTheirPlace) {
  for (std::size_t i = 0; i < patches_.size(); ++i)
    textplane_test::keep_pixels(patches_[i], 10 + 2 * static_cast<int>(i));  // some have too many
  patches_[2].levels[0].intensity[3] = std::numeric_limits<float>::quiet_NaN();
  terms_[4].scale_shift = 1;
  terms_[5].weight = 0;
  terms_[6].patch = nullptr;
  terms_[7].T_w_h.t.x() = 100;  // out of view
  terms_[8].theta *= -1;        // behind
  terms_[9].weight = 2;
  std::vector<float> a, b;
  expect_same(together(&a), one_by_one(&b));
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i], b[i], 1e-4F) << i;
  for (const std::size_t i : {5u, 6u, 7u, 8u}) EXPECT_EQ(a[i], -1.0F) << i;
}

// A text of which a part leaves the image counts by what is left of it.
TEST_F(PoseBatchTest, TextsAtTheBorderLosePixels) {
  cut_all(30);
  options_.solve.max_lost_fraction = 1;
  for (int i = 0; i < 8; ++i) {
    // The image begins in the middle of the first column of texts.
    terms_[static_cast<std::size_t>(i)].T_w_h.t.x() -= 0.5 + 0.02 * i;
  }
  const tp::PoseFit fit = together();
  expect_same(fit, one_by_one());
  EXPECT_LT(fit.visible_pixels, 30 * fit.texts);
}

TEST_F(PoseBatchTest, ImagesThatTheKernelDoesNotTakeGoTheOldWay) {
  cut_all(20);
  options_.photometric.precise = true;
  const tp::PoseFit precise = together();
  EXPECT_EQ(precise.path, tp::Path::reference);
  options_.photometric.precise = false;
  expect_same(together(), precise);
  options_.policy = tp::LinearisePolicy::esm;
  expect_same(together(), one_by_one());
}

// A run at the pose of the last one is not repeated; at any other it is.
TEST_F(PoseBatchTest, RunsWhereThePoseIsAnother) {
  cut_all(20);
  tp::detail::PoseBatch batch;
  batch.reserve(count());
  batch.clear();
  for (int i = 0; i < count(); ++i) {
    const auto at = static_cast<std::size_t>(i);
    batch.add({i, patches_[at].levels[0].view(), patches_[at].camera, terms_[at].theta, tp::SE3d()});
  }
  batch.pack();
  const auto cost_at = [&](const tp::SE3d& T_c_w) {
    tp::NormalEquations<6> n{tp::detail::Unset()};
    batch.run(T_c_w, wall().frame.view().level[0], wall().camera, {});
    EXPECT_TRUE(batch.take(3, false, &n));
    return n.cost;
  };
  tp::SE3d shifted = wall().start, turned = wall().start;
  shifted.t.x() += 0.01;
  turned.R = tp::so3_exp<double>(tp::Vector3<double>(0, 0.003, 0)) * turned.R;
  const double cost = cost_at(wall().start);
  EXPECT_EQ(cost_at(wall().start), cost);
  EXPECT_NE(cost_at(shifted), cost);
  EXPECT_EQ(cost_at(wall().start), cost);
  EXPECT_NE(cost_at(turned), cost);
}

// Memory of many texts serves few, and that of few, who need no batch, serves them alone.
TEST_F(PoseBatchTest, OneWorkspaceServesFrameAfterFrame) {
  cut_all(20);
  tp::PoseWorkspace workspace;
  workspace.reserve(terms_.data(), count(), 0);
  const auto solve_in = [&](tp::PoseWorkspace& memory, int texts) {
    return tp::refine_pose(terms_.data(), texts, nullptr, 0, wall().frame.view(), wall().camera, wall().start, options_,
                           memory);
  };
  const auto solve = [&](int texts) { return solve_in(workspace, texts); };
  const tp::PoseFit all = solve(count()), few = solve(3), again = solve(count());
  EXPECT_EQ(few.texts, 3);
  tp::PoseWorkspace of_three;
  of_three.reserve(terms_.data(), 3, 0);
  EXPECT_EQ(solve_in(of_three, 3).T_t_w.t, few.T_t_w.t);
  EXPECT_EQ(again.T_t_w.t, all.T_t_w.t) << "the same bits";
  EXPECT_EQ(again.T_t_w.R, all.T_t_w.R);
  tp::PoseWorkspace small;
  small.reserve(terms_.data(), 4, 0);
  EXPECT_EQ(solve_in(small, count()).status, tp::Status::invalid_argument);
}

}  // namespace pose_batch_test
