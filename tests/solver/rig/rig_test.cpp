// refine_pose() of a rig: several cameras with fixed extrinsics, one pose.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "solver/pose_scene.hpp"

namespace rig_test {
using namespace textplane_test::planar;
using textplane::CameraView;
using textplane::PoseCameraF;
using textplane::PoseFit;
using textplane::PosePointTerm;
using textplane::PoseTextTerm;
using textplane::Status;
namespace tp = textplane;

SE3d pose(double x, double y, double z, double rx, double ry, double rz) {
  Vec6 xi;
  xi << x, y, z, rx, ry, rz;
  return tp::se3_exp<double>(xi);
}

const tp::LensMap& fisheye() {
  static const tp::LensMap map(tp::KannalaBrandt<double>{{}, 0.01, -0.003, 0.002, -0.001});
  return map;
}

// Cameras with what each sees of random points at the true pose of the rig.
struct Rig {
  SE3d T_r_w = pose(0.3, -0.2, 0.1, 0.2, -0.4, 0.1);
  std::vector<PoseCameraF> cameras;
  std::vector<PosePointTerm> points;

  SE3d T_c_w(std::size_t c, const SE3d& rig) const { return cameras[c].T_r_c.inverse() * rig; }
  void add_points(int per_camera, double noise = 0, unsigned seed = 9) {
    Random random(seed);
    for (std::size_t c = 0; c < cameras.size(); ++c) {
      const CameraView& camera = cameras[c].camera;
      for (int n = 0; n < per_camera;) {
        const double z = random.uniform(1.5, 6);
        const Vec3 p(z * random.uniform(-1.2, 1.2), z * random.uniform(-1.2, 1.2), z);
        if (!camera.in_domain(p)) continue;
        const Vec2 e(noise * random.normal(), noise * random.normal());
        points.push_back({T_c_w(c, T_r_w).inverse() * p, camera.project(p) + e, 1 + 0.5 * random.uniform(0, 1),
                          static_cast<int>(c)});
        ++n;
      }
    }
  }
  PoseFit solve(const SE3d& start, const std::vector<PoseTextTerm>& texts = {}, tp::PoseOptions options = {},
                float* chi2 = nullptr) const {
    const int n = static_cast<int>(texts.size()), m = static_cast<int>(points.size());
    tp::PoseWorkspace workspace;
    workspace.reserve(texts.data(), n, m);
    return refine_pose(texts.data(), n, points.data(), m, cameras.data(), static_cast<int>(cameras.size()), start,
                       options, workspace, nullptr, chi2);
  }
};

Rig stereo() {
  Rig rig;
  rig.cameras = {{CameraView(260, 255, 160.3, 118.9), SE3d(), {}},
                 {CameraView(300, 301, 150, 121), pose(0.12, 0.01, -0.02, 0.02, -0.05, 0.01), {}}};
  return rig;
}

// Back to back: what one sees, the other does not.
Rig fisheyes() {
  Rig rig;
  const CameraView camera({150, 151, 200, 201}, &fisheye());
  rig.cameras = {{camera, pose(0.02, 0, 0.05, 0.03, 0.02, 0), {}},
                 {camera, pose(-0.03, 0.01, -0.05, 0.02, 3.1, -0.04), {}}};
  return rig;
}

template <class Problem>
std::vector<double> errors(const Problem& problem, const SE3d& T_r_w) {
  std::vector<double> all;
  problem.for_each_error(T_r_w, [&](int, const Vec2& e) { all.insert(all.end(), {e[0], e[1]}); });
  return all;
}

TEST(Rig, NormalEquationsAreThoseOfTheErrors) {
  for (Rig rig : {stereo(), fisheyes()}) {
    rig.add_points(20, 0.5);
    for (PosePointTerm& p : rig.points) p.sigma = 1;
    const int m = static_cast<int>(rig.points.size());
    tp::PoseOptions options;
    options.point_robust = {tp::RobustKind::huber, 1e6};
    tp::PoseWorkspace workspace;
    workspace.reserve(nullptr, 0, m);
    tp::detail::PoseProblem<tp::PyramidViewF> problem(nullptr, 0, rig.points.data(), m, rig.cameras.data(), 2, options,
                                                      workspace);
    const SE3d at = pose(0.01, -0.02, 0.015, 0.006, 0.004, -0.005) * rig.T_r_w;
    const tp::detail::PoseSystem system = problem.linearise(at);
    const std::vector<double> e = errors(problem, at);
    ASSERT_EQ(e.size(), 2 * rig.points.size());
    Eigen::MatrixXd J(static_cast<Eigen::Index>(e.size()), 6);
    const double h = 1e-6;
    for (int i = 0; i < 6; ++i) {
      const std::vector<double> above = errors(problem, problem.retract(at, h * Vec6::Unit(i))),
                                below = errors(problem, problem.retract(at, -h * Vec6::Unit(i)));
      for (std::size_t k = 0; k < e.size(); ++k) J(static_cast<Eigen::Index>(k), i) = (above[k] - below[k]) / (2 * h);
    }
    const Eigen::Map<const Eigen::VectorXd> r(e.data(), static_cast<Eigen::Index>(e.size()));
    const Eigen::MatrixXd H = J.transpose() * J;
    EXPECT_LT((H - system.H).norm(), 1e-7 * H.norm());
    EXPECT_LT((J.transpose() * r - system.b).norm(), 1e-7 * (J.transpose() * r).norm());
    EXPECT_NEAR(system.cost, r.squaredNorm(), 1e-9 * r.squaredNorm());
    EXPECT_DOUBLE_EQ(problem.evaluate(at).cost, system.cost);
  }
}

TEST(Rig, ExactPointsGiveThePose) {
  Random random(2);
  for (Rig rig : {stereo(), fisheyes()}) {
    rig.add_points(15);
    for (int trial = 0; trial < 5; ++trial) {
      const PoseFit fit = rig.solve(tp::se3_exp<double>(random.twist(0.05, 0.03)) * rig.T_r_w, {}, pose_test::tight());
      EXPECT_TRUE(is_ok(fit.status)) << to_string(fit.status);
      EXPECT_LT(pose_distance(fit.T_t_w, rig.T_r_w), 1e-9);
      EXPECT_EQ(fit.inlier_points, 30);
    }
  }
}

// One point in each of four cameras: none of them alone determines a pose.
TEST(Rig, FourCamerasOfOnePointEach) {
  Rig rig = fisheyes();
  const CameraView camera = rig.cameras[0].camera;
  rig.cameras.push_back({camera, pose(0, 0.2, 0, 0, 1.5, 0), {}});
  rig.cameras.push_back({camera, pose(0.1, 0, 0, 1.5, 0, 0), {}});
  rig.add_points(1);
  const PoseFit fit = rig.solve(pose(0.02, -0.01, 0.01, 0.01, 0.02, -0.01) * rig.T_r_w, {}, pose_test::tight());
  EXPECT_TRUE(is_ok(fit.status)) << to_string(fit.status);
  EXPECT_LT(pose_distance(fit.T_t_w, rig.T_r_w), 1e-8);
  rig.points.resize(2);
  EXPECT_EQ(rig.solve(rig.T_r_w).status, Status::rank_deficient);
}

// The extrinsics matter: with those of another rig the pose is another.
TEST(Rig, WrongExtrinsicsGiveAnotherPose) {
  Rig rig = stereo();
  rig.add_points(15);
  rig.cameras[1].T_r_c.t[0] += 0.02;
  EXPECT_GT(pose_distance(rig.solve(rig.T_r_w).T_t_w, rig.T_r_w), 1e-4);
}

// Two cameras that see three signs each, and the signs' pixels as each camera has them.
struct Signs {
  Scene scene = three_signs();
  Rig rig;
  std::array<FloatPyramid, 2> images;
  std::vector<TextPatch> patches;
  std::vector<PoseTextTerm> texts;

  Signs() {
    rig.T_r_w = target_pose();
    rig.cameras = {{scene.camera, pose(0.05, 0, 0.01, 0, 0.03, 0), {}},
                   {scene.camera, pose(-0.05, 0.01, 0, 0.01, -0.03, 0.02), {}}};
    for (std::size_t c = 0; c < 2; ++c) {
      const SE3d T_c_w = rig.T_c_w(c, rig.T_r_w);
      images[c] = scene.render(T_c_w);
      rig.cameras[c].target = images[c].view();
      for (const Sign& sign : scene.signs) patches.push_back(scene.exact_patch(sign, images[c], T_c_w));
    }
    for (std::size_t i = 0; i < patches.size(); ++i) {
      texts.push_back({&patches[i], scene.signs[i % 3].theta, scene.signs[i % 3].T_w_h, 1});
      texts.back().camera = static_cast<int>(i / 3);
    }
  }
};

TEST(Rig, TextsOfTwoCamerasGiveThePose) {
  Signs s;
  Random random(6);
  for (int trial = 0; trial < 3; ++trial) {
    const SE3d start = tp::se3_exp<double>(random.twist(0.01, 0.005)) * s.rig.T_r_w;
    const PoseFit fit = s.rig.solve(start, s.texts, pose_test::tight());
    EXPECT_TRUE(is_ok(fit.status)) << to_string(fit.status);
    EXPECT_EQ(fit.texts, 6);
    EXPECT_GT(fit.zncc, 0.9999);
    EXPECT_LT(pose_distance(fit.T_t_w, s.rig.T_r_w), 1e-6);
  }
  // One sign in each, with points.
  s.rig.add_points(5);
  const PoseFit few = s.rig.solve(tp::se3_exp<double>(random.twist(0.01, 0.005)) * s.rig.T_r_w,
                                  {s.texts[0], s.texts[4]}, pose_test::tight());
  EXPECT_TRUE(is_ok(few.status)) << to_string(few.status);
  EXPECT_EQ(few.texts, 2);
  EXPECT_LT(pose_distance(few.T_t_w, s.rig.T_r_w), 1e-6);
}

// A text is looked for in the image of the camera that it names.
TEST(Rig, TermsNameTheirCamera) {
  Signs s;
  const FloatPyramid blank = s.images[1].map([](double) { return 90; });
  s.rig.cameras[1].target = blank.view();
  EXPECT_EQ(s.rig.solve(s.rig.T_r_w, s.texts).texts, 3);
  for (PoseTextTerm& text : s.texts) text.camera = 1;
  EXPECT_EQ(s.rig.solve(s.rig.T_r_w, s.texts).status, Status::no_contrast);
}

bool same_bits(const PoseFit& a, const PoseFit& b) {
  return a.T_t_w.R == b.T_t_w.R && a.T_t_w.t == b.T_t_w.t && a.information == b.information && a.cost == b.cost &&
         a.zncc == b.zncc && a.iterations == b.iterations && a.status == b.status;
}

TEST(Rig, OneCameraAtTheRigsOriginIsTheSameToTheBit) {
  pose_test::Input input(false, 40, 0.5);
  const SE3d start = pose(0.01, 0.005, -0.01, 0.004, -0.003, 0.002) * input.truth;
  const PoseFit alone = input.solve(start);
  Rig rig;
  rig.cameras = {{input.scene.camera, SE3d(), input.target.view()}};
  rig.points = input.points;
  EXPECT_TRUE(same_bits(alone, rig.solve(start, input.texts)));
}

// Elsewhere on the rig: the same pose, seen from there, with its information moved by the adjoint.
TEST(Rig, OneCameraElsewhereGivesTheSamePose) {
  pose_test::Input input(false, 40, 0.5);
  const SE3d start = pose(0.01, 0.005, -0.01, 0.004, -0.003, 0.002) * input.truth;
  const PoseFit alone = input.solve(start, pose_test::tight());
  Rig rig;
  rig.cameras = {{input.scene.camera, pose(0.3, -0.2, 0.1, 0.5, -1, 0.3), input.target.view()}};
  rig.points = input.points;
  const SE3d& T_r_c = rig.cameras[0].T_r_c;
  const PoseFit fit = rig.solve(T_r_c * start, input.texts, pose_test::tight());
  EXPECT_LT(pose_distance(T_r_c.inverse() * fit.T_t_w, alone.T_t_w), 1e-6);
  const Eigen::Matrix<double, 6, 6> A = tp::adjoint(SE3d(T_r_c.inverse()));
  EXPECT_LT((A.transpose() * alone.information * A - fit.information).norm(), 1e-4 * fit.information.norm());
  EXPECT_EQ(fit.visible_pixels, alone.visible_pixels);
}

TEST(Rig, SaysWhatIsWrong) {
  Rig rig = stereo();
  rig.add_points(5);
  std::vector<float> chi2(rig.points.size(), 7);
  Rig bad = rig;
  bad.points[3].camera = 2;
  EXPECT_EQ(bad.solve(rig.T_r_w, {}, {}, chi2.data()).status, Status::invalid_argument);
  EXPECT_EQ(chi2[0], -1.0F);
  bad.points[3].camera = -1;
  EXPECT_EQ(bad.solve(rig.T_r_w).status, Status::invalid_argument);
  bad = rig;
  bad.cameras.clear();
  EXPECT_EQ(bad.solve(rig.T_r_w).status, Status::invalid_argument);
  bad = rig;
  bad.cameras[1].T_r_c.t[0] = std::numeric_limits<double>::quiet_NaN();
  const PoseFit fit = bad.solve(rig.T_r_w);
  EXPECT_EQ(fit.status, Status::non_finite);
  EXPECT_TRUE(fit.T_t_w.R == rig.T_r_w.R && fit.T_t_w.t == rig.T_r_w.t);
  bad = rig;
  bad.cameras[1].camera.pinhole.fx = -1;
  EXPECT_EQ(bad.solve(rig.T_r_w).status, Status::invalid_argument);

  // A term of another camera than the only one.
  tp::PoseWorkspace workspace;
  workspace.reserve(nullptr, 0, 10);
  EXPECT_EQ(refine_pose(nullptr, 0, rig.points.data(), 10, tp::PyramidViewF(), rig.cameras[0].camera, rig.T_r_w,
                        tp::PoseOptions(), workspace)
                .status,
            Status::invalid_argument);
}

}  // namespace rig_test
