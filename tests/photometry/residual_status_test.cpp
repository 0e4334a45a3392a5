// What the photometric kernels answer to input that they cannot use: a status and zeros, never a NaN.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "photometry/scene.hpp"
#include "textplane/photometry/residual.hpp"
#include "textplane/photometry/residual_autodiff.hpp"

namespace tp = textplane;
using textplane_test::all_zero;
using textplane_test::Scene;
using tp::Status;

namespace residual_status_test {

const double kNaN = std::numeric_limits<double>::quiet_NaN();
const double kInf = std::numeric_limits<double>::infinity();

// Calls every kernel and checks that all of them answer `expected`, with zeros.
template <class T>
void expect_status(const tp::BasicPhotometricInput<T>& input, const tp::Vector3<double>& theta, const tp::SE3d& T_t_h,
                   const tp::PhotometricOptions& options, tp::PhotometricWorkspace& workspace, Status expected) {
  const auto plane =
      tp::reference::linearise<tp::Parameters::plane>(tp::ResidualRequest{input, theta, T_t_h, options}, workspace);
  const auto pose =
      tp::reference::linearise<tp::Parameters::pose>(tp::ResidualRequest{input, theta, T_t_h, options}, workspace);
  const auto both = tp::reference::linearise<tp::Parameters::pose_plane>(
      tp::ResidualRequest{input, theta, T_t_h, options}, workspace);
  const auto all = tp::reference::linearise<tp::Parameters::host_target_plane>(
      tp::world_request(input, theta, T_t_h, tp::SE3d(), tp::PerturbationSide::right, options), workspace);
  const auto cost = tp::reference::evaluate(tp::ResidualRequest{input, theta, T_t_h, options}, workspace);
  EXPECT_EQ(plane.status, expected) << tp::to_string(plane.status);
  EXPECT_EQ(pose.status, expected) << tp::to_string(pose.status);
  EXPECT_EQ(both.status, expected) << tp::to_string(both.status);
  EXPECT_EQ(all.status, expected) << tp::to_string(all.status);
  EXPECT_EQ(cost.status, expected) << tp::to_string(cost.status);
  EXPECT_TRUE(all_zero(plane) && all_zero(pose) && all_zero(both) && all_zero(all));
  EXPECT_EQ(cost.cost, 0);
  EXPECT_EQ(cost.error, 0);
  EXPECT_EQ(cost.zncc, 0);

  const auto n = static_cast<std::size_t>(std::max(input.patch.n, 0));
  std::vector<double> r(n + 1, 7), J(n * 9 + 1, 7);
  const auto summary = tp::reference::residuals<tp::Parameters::pose_plane>(
      tp::ResidualRequest{input, theta, T_t_h, options}, workspace, r.data(), J.data());
  EXPECT_EQ(summary.status, expected) << tp::to_string(summary.status);
  for (std::size_t i = 0; i < n; ++i) EXPECT_EQ(r[i], 0);
  for (std::size_t i = 0; i < n * 9; ++i) EXPECT_EQ(J[i], 0);
  EXPECT_EQ(r[n], 7);
  EXPECT_EQ(J[n * 9], 7);
}

struct ResidualStatus : testing::Test {
  Scene<std::uint8_t> scene{1};
  tp::PhotometricInput input = scene.input();
  tp::PhotometricOptions options;

  void expect(Status expected) { expect_status(input, scene.theta, scene.T_t_h, options, scene.workspace, expected); }
};

TEST_F(ResidualStatus, TooFewPixels) {
  input.patch.n = 14;
  expect(Status::too_few);
  input.patch.n = 0;
  expect(Status::too_few);
  input.patch.n = 15;
  EXPECT_EQ(
      tp::reference::evaluate(tp::ResidualRequest{input, scene.theta, scene.T_t_h, options}, scene.workspace).status,
      Status::ok);
  options.min_visible = 16;
  expect(Status::too_few);
}

TEST_F(ResidualStatus, NoMinimumStillNeedsContrast) {
  options.min_visible = -3;
  input.patch.n = 1;
  expect(Status::no_contrast);
  input.patch.n = 0;
  expect(Status::too_few);
}

TEST_F(ResidualStatus, NoContrastOfTheTarget) {
  scene.image.resize(scene.kWidth, scene.kHeight, 77);
  input = scene.input();
  expect(Status::no_contrast);
  options.min_contrast = 0;
  expect(Status::no_contrast);
}

TEST_F(ResidualStatus, NoContrastOfTheHost) {
  scene.intensity.assign(scene.intensity.size(), 0.1f);
  input = scene.input();
  expect(Status::no_contrast);
  options.min_contrast = 0;
  expect(Status::no_contrast);
}

TEST_F(ResidualStatus, ContrastIsThePopulationStandardDeviation) {
  const auto sums = tp::reference::linearise<tp::Parameters::pose>(
      tp::ResidualRequest{input, scene.theta, scene.T_t_h, options}, scene.workspace);
  const double target = sums.s / std::sqrt(static_cast<double>(sums.visible));
  const auto stats = tp::intensity_stats(scene.intensity.data(), nullptr, scene.n());
  const double host = stats.s / std::sqrt(static_cast<double>(scene.n()));
  options.min_contrast = std::min(target, host) * (1 - 1e-9);
  EXPECT_EQ(
      tp::reference::evaluate(tp::ResidualRequest{input, scene.theta, scene.T_t_h, options}, scene.workspace).status,
      Status::ok);
  options.min_contrast = std::min(target, host) * (1 + 1e-9);
  expect(Status::no_contrast);
}

TEST_F(ResidualStatus, BehindEitherCamera) {
  scene.theta = -scene.theta;  // the plane lies behind the host
  expect(Status::behind_camera);
  scene.theta = -scene.theta;
  scene.T_t_h.t[2] = -20;  // and here behind the target
  expect(Status::behind_camera);
  scene.theta.setZero();  // at infinity: no depth
  expect(Status::behind_camera);
}

TEST_F(ResidualStatus, OutOfTheTarget) {
  scene.T_t_h.t[0] = 100;
  expect(Status::out_of_view);
  // A turn by half a revolution about the camera centre puts the plane behind it instead.
  scene.T_t_h = tp::se3_exp<double>((tp::Vector6<double>() << 0, 0, 0, 0, 3.14159, 0).finished());
  expect(Status::behind_camera);
}

TEST_F(ResidualStatus, NonFinitePlanePoseAndCamera) {
  for (const double bad : {kNaN, kInf, -kInf}) {
    for (int i = 0; i < 3; ++i) {
      Scene<std::uint8_t> broken = scene;
      broken.theta[i] = bad;
      expect_status(broken.input(), broken.theta, broken.T_t_h, options, broken.workspace, Status::non_finite);
      broken = scene;
      broken.T_t_h.t[i] = bad;
      expect_status(broken.input(), broken.theta, broken.T_t_h, options, broken.workspace, Status::non_finite);
      for (int j = 0; j < 3; ++j) {
        broken = scene;
        broken.T_t_h.R(i, j) = bad;
        expect_status(broken.input(), broken.theta, broken.T_t_h, options, broken.workspace, Status::non_finite);
      }
    }
    for (tp::Pinhole<double>* camera : {&input.host_camera, &input.target_camera})
      for (double* value : {&camera->fx, &camera->fy, &camera->cx, &camera->cy}) {
        const double before = *value;
        *value = bad;
        expect(Status::non_finite);
        *value = before;
      }
  }
}

TEST_F(ResidualStatus, OverflowIsNotPassedOn) {
  // Huge but finite: products overflow or everything leaves the image. No result may hold a NaN and call itself ok.
  for (const double huge : {1e150, 1e300, 1.7e308}) {
    for (const tp::Vector3<double>& theta : {tp::Vector3<double>(huge, 0, 0), {0, huge, huge}, {huge, huge, huge}})
      for (const double t : {0.0, 1.0, 1e-300, huge}) {
        tp::SE3d T;
        T.t = {t, -t, t};
        const auto sums = tp::reference::linearise<tp::Parameters::pose_plane>(
            tp::ResidualRequest{input, theta, T, options}, scene.workspace);
        if (tp::is_ok(sums.status)) {
          EXPECT_TRUE(tp::all_finite(sums.H) && tp::all_finite(sums.b) && tp::is_finite(sums.cost));
        } else {
          EXPECT_TRUE(all_zero(sums));
        }
      }
  }
}

TEST_F(ResidualStatus, OverflowOfTheSumsIsNonFinite) {
  // Identity and a huge theta: the warp is finite, but the squared derivatives by v overflow.
  scene.T_t_h = tp::SE3d();
  scene.theta = {0, 0, 1e200};
  const auto sums = tp::reference::linearise<tp::Parameters::pose>(
      tp::ResidualRequest{input, scene.theta, scene.T_t_h, options}, scene.workspace);
  EXPECT_EQ(sums.status, Status::non_finite);
  EXPECT_TRUE(all_zero(sums));
}

TEST_F(ResidualStatus, BadCameras) {
  for (double* value :
       {&input.host_camera.fx, &input.host_camera.fy, &input.target_camera.fx, &input.target_camera.fy}) {
    const double before = *value;
    for (const double bad : {0.0, -200.0}) {
      *value = bad;
      expect(Status::invalid_argument);
    }
    *value = before;
  }
}

TEST_F(ResidualStatus, BadImages) {
  using View = tp::ImageView8;
  const std::uint8_t* data = scene.image.data();
  for (const View& bad : {View(), View(data, 0, 0), View(nullptr, 10, 10), View(data, 200, 160, 199),
                          View(data, 200, 160, -200), View(data, -5, 160), View(data, 200, -1)}) {
    input.target = bad;
    expect(Status::invalid_argument);
  }
  const std::vector<std::uint8_t> one = {9};
  input.target = {one.data(), 1, 1};
  expect(Status::out_of_view);
}

TEST_F(ResidualStatus, SinglePixelImageThatIsHit) {
  // Every host pixel is (0, 0), which is all that the target has.
  const std::vector<float> zeros(20, 0.0f);
  std::vector<float> intensity;
  for (int i = 0; i < 20; ++i) intensity.push_back(static_cast<float>(10 * i));
  const std::vector<std::uint8_t> one = {9};
  input.patch = {zeros.data(), zeros.data(), intensity.data(), nullptr, 20};
  input.host_camera = input.target_camera = tp::Pinhole<double>();
  input.target = {one.data(), 1, 1};
  scene.T_t_h = tp::SE3d();
  scene.theta = {0, 0, 1};
  expect(Status::no_contrast);
}

TEST_F(ResidualStatus, BadPatches) {
  const tp::PatchView good = input.patch;
  input.patch.x = nullptr;
  expect(Status::invalid_argument);
  input.patch = good;
  input.patch.y = nullptr;
  expect(Status::invalid_argument);
  input.patch = good;
  input.patch.intensity = nullptr;
  expect(Status::invalid_argument);
  input.patch = good;
  input.patch.n = -1;
  expect(Status::invalid_argument);
  input = {};
  expect(Status::invalid_argument);
}

TEST_F(ResidualStatus, WorkspaceThatIsTooSmall) {
  tp::PhotometricWorkspace small(scene.n() - 1), empty;
  expect_status(input, scene.theta, scene.T_t_h, options, small, Status::invalid_argument);
  expect_status(input, scene.theta, scene.T_t_h, options, empty, Status::invalid_argument);
  small.reserve(scene.n());
  EXPECT_EQ(small.capacity(), scene.n());
  EXPECT_EQ(tp::reference::evaluate(tp::ResidualRequest{input, scene.theta, scene.T_t_h, options}, small).status,
            Status::ok);
  small.reserve(3);
  EXPECT_EQ(small.capacity(), scene.n());
}

TEST_F(ResidualStatus, BadOptions) {
  options.robust.delta = 0;
  expect(Status::invalid_argument);
  options.robust.delta = kNaN;
  expect(Status::invalid_argument);
  options = {};
  options.min_contrast = kNaN;
  expect(Status::invalid_argument);
}

TEST_F(ResidualStatus, ResidualsWithoutRoomForThem) {
  const auto summary = tp::reference::residuals<tp::Parameters::plane>(
      tp::ResidualRequest{input, scene.theta, scene.T_t_h, options}, scene.workspace, nullptr, nullptr);
  EXPECT_EQ(summary.status, Status::invalid_argument);
  EXPECT_EQ(summary.visible, 0);  // no pixel was looked at
}

TEST_F(ResidualStatus, TemplatedResidualRefusesWhatItsSetCannotSee) {
  std::vector<double> r(scene.x.size());
  const std::vector<std::uint8_t> all(scene.x.size(), 1), none(scene.x.size(), 0);
  const auto call = [&](const tp::Vector3<double>& theta, const tp::SE3d& T, const std::uint8_t* set) {
    return tp::reference::residuals_t(input, theta, T, set, nullptr, r.data());
  };
  EXPECT_EQ(call(scene.theta, scene.T_t_h, all.data()), Status::ok);
  EXPECT_EQ(call(-scene.theta, scene.T_t_h, all.data()), Status::behind_camera);
  tp::SE3d away = scene.T_t_h;
  away.t[0] = 100;
  EXPECT_EQ(call(scene.theta, away, all.data()), Status::out_of_view);
  EXPECT_EQ(call(scene.theta, scene.T_t_h, none.data()), Status::too_few);
  EXPECT_EQ(call(scene.theta, scene.T_t_h, nullptr), Status::invalid_argument);
  scene.image.resize(scene.kWidth, scene.kHeight, 50);
  input = scene.input();
  EXPECT_EQ(call(scene.theta, scene.T_t_h, all.data()), Status::no_contrast);
}

}  // namespace residual_status_test
