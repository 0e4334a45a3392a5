// Dense patches through tiles of the target: the same bits as one by one. A target whose rows are 32 KiB apart takes no
// tiles, so the same pixels out of such a copy are what is expected, whatever the order of the host's pixels, the pose
// and the border.
#include <algorithm>
#include <cstring>

#include "simd/policy_support.hpp"
#include "support/guarded.hpp"
#include "textplane/core/cameras/radial_tangential.hpp"

namespace tiles_test {
namespace tp = textplane;
using namespace textplane_test;

constexpr int kFar = 32768;

enum class Order { rows, reversed, mirrored, upside_down, serpentine, columns, holes, shuffled };

// Pixels of a grid around the origin of the host camera, in one order or another.
struct Patch : tp::PatchLevel {
  Patch(int columns, int rows, Order order, unsigned seed) {
    Random random(seed);
    for (int i = 0; i < rows; ++i)
      for (int j = 0; j < columns; ++j) {
        if (order == Order::holes && random.integer(0, 4) == 0) continue;
        const bool back = order == Order::mirrored || (order == Order::serpentine && i % 2 == 1);
        const int row = order == Order::upside_down ? rows - 1 - i : i;
        x.push_back(static_cast<float>((back ? columns - 1 - j : j) - columns / 2));
        y.push_back(static_cast<float>(row - rows / 2));
      }
    if (order == Order::columns) {
      std::swap(x, y);
    } else if (order == Order::reversed) {
      std::reverse(x.begin(), x.end());
      std::reverse(y.begin(), y.end());
    } else if (order == Order::shuffled) {
      for (std::size_t i = x.size() - 1; i > 0; --i) {
        const auto j = static_cast<std::size_t>(random.integer(0, static_cast<int>(i)));
        std::swap(x[i], x[j]);
        std::swap(y[i], y[j]);
      }
    }
    for (std::size_t i = 0; i < x.size(); ++i) {
      intensity.push_back(static_cast<float>(random.uniform(0, 255)));
      gx.push_back(static_cast<float>(random.uniform(-40, 40)));
      gy.push_back(static_cast<float>(random.uniform(-40, 40)));
    }
  }
};

// One noisy image twice: between pages that may not be touched, and with rows far apart.
class Targets {
 public:
  Targets(int width, int height, int stride, bool at_end)
      : width_(width),
        height_(height),
        stride_(stride),
        tight_(static_cast<std::size_t>((height - 1) * stride + width)),
        far_(static_cast<std::size_t>((height - 1) * kFar + width)),
        first_(at_end ? tight_.data() : tight_.front()) {
    Random random(static_cast<unsigned>(width));
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x)
        first_[y * stride + x] = far_[static_cast<std::size_t>(y * kFar + x)] =
            static_cast<std::uint8_t>(random.integer(0, 255));
  }
  tp::ImageView8 near_view() const { return tp::ImageView8(first_, width_, height_, stride_); }
  tp::ImageView8 far_view() const { return tp::ImageView8(far_.data(), width_, height_, kFar); }

 private:
  int width_, height_, stride_;
  Guarded<std::uint8_t> tight_;
  std::vector<std::uint8_t> far_;
  std::uint8_t* first_;
};

template <int P>
void expect_same(const tp::NormalEquations<P>& a, const tp::NormalEquations<P>& b) {
  EXPECT_EQ(a.status, b.status);
  EXPECT_EQ(a.visible, b.visible);
  EXPECT_EQ(std::memcmp(a.H.data(), b.H.data(), sizeof(double) * P * P), 0);
  EXPECT_EQ(std::memcmp(a.b.data(), b.b.data(), sizeof(double) * P), 0);
  EXPECT_EQ(a.cost, b.cost);
  EXPECT_EQ(a.error, b.error);
}

constexpr int kWidth = 211, kHeight = 173;

// The patch, its middle on the host's axis, and cameras for targets of kWidth x kHeight.
tp::PhotometricInput input_of(const Patch& patch) {
  tp::PhotometricInput in;
  in.patch = patch.view();
  in.host_camera = tp::Pinhole<double>(150, 150, 0, 0);
  in.target_camera = tp::Pinhole<double>(150, 150, kWidth / 2.0, kHeight / 2.0);
  return in;
}

// The patch turned by `angle` about the middle of the host, `scale` times as large, with its middle at (x, y) of the
// target.
tp::SE3d motion(double angle, double scale, double x, double y, const tp::PhotometricInput& in) {
  const double z = 1 / scale, f = in.target_camera.fx;
  tp::SE3d T = tp::se3_exp<double>((tp::Vector6<double>() << 0, 0, 0, 0.002, -0.003, angle).finished());
  T.t = {(x - in.target_camera.cx) / f * z, (y - in.target_camera.cy) / f * z, z - 1};
  return T;
}

// What the kernels need of a patch.
struct Prepared {
  explicit Prepared(const tp::PhotometricInput& input) : in(input), workspace(in.patch.n) {
    EXPECT_EQ(patch.prepare(in.patch), tp::Status::ok);
  }
  tp::PhotometricInput in;
  tp::PhotometricWorkspace workspace;
  tp::TemplatePatch patch;
};

// Every kernel that takes tiles. Returns whether the whole patch was visible.
bool expect_same_of_all(Prepared& prepared, const tp::SE3d& T, const Targets& targets) {
  tp::PhotometricInput& in = prepared.in;
  tp::PhotometricWorkspace& workspace = prepared.workspace;
  const tp::Vector3<double> theta(0, 0, 1);
  tp::PhotometricOptions o;
  o.min_visible = 1;
  const auto run = [&](const tp::ImageView8& target, auto f) {
    in.target = target;
    return f();
  };
  const auto both = [&](auto f) { expect_same(run(targets.near_view(), f), run(targets.far_view(), f)); };
  both([&] { return tp::linearise<tp::Parameters::pose_plane>(tp::ResidualRequest{in, theta, T, o}, workspace); });
  both([&] { return tp::linearise<tp::Parameters::pose>(tp::ResidualRequest{in, theta, T, o}, workspace); });
  both([&] { return tp::linearise<tp::Parameters::plane>(tp::ResidualRequest{in, theta, T, o}, workspace); });
  both([&] {
    return tp::linearise<tp::Parameters::pose_plane>(
        tp::ResidualRequest{in, theta, T, o}.by(tp::LinearisePolicy::template_jacobian, &prepared.patch), workspace);
  });
  both([&] {
    return tp::linearise<tp::Parameters::pose>(
        tp::ResidualRequest{in, theta, T, o}.by(tp::LinearisePolicy::esm, &prepared.patch), workspace);
  });
  const auto cost = [&] { return tp::evaluate(tp::ResidualRequest{in, theta, T, o}, workspace); };
  const auto near = run(targets.near_view(), cost), far = run(targets.far_view(), cost);
  EXPECT_EQ(near.cost, far.cost);
  EXPECT_EQ(near.error, far.error);
  EXPECT_EQ(near.visible, far.visible);
  return near.visible == in.patch.n;
}

TEST(Tiles, SameBitsInEveryOrderAndPose) {
  const Targets targets(kWidth, kHeight, 240, true);
  const int sizes[][2] = {{37, 29}, {100, 40}, {13, 31}, {64, 9}};
  int whole = 0, all = 0;
  for (const auto& size : sizes)
    for (const Order order : {Order::rows, Order::reversed, Order::mirrored, Order::upside_down, Order::serpentine,
                              Order::columns, Order::holes, Order::shuffled}) {
      const Patch patch(size[0], size[1], order, static_cast<unsigned>(size[0]));
      Prepared prepared(input_of(patch));
      for (const tp::simd::Target target : testable_targets()) {
        const TargetScope scope(target);
        SCOPED_TRACE(tp::simd::to_string(target));
        // 0.14 and more are a row in eight pixels; from 1.9 on no tile holds eight.
        for (const double angle : {0.0, 0.01, -0.012, 0.06, -0.13, 0.15, -0.3, 1.5, 3.1})
          for (const double scale : {1.0, 0.6, 1.35, 1.7, 2.1}) {
            const tp::SE3d T = motion(angle, scale, 104.3, 87.8, prepared.in);
            whole += expect_same_of_all(prepared, T, targets);
            ++all;
          }
      }
    }
  EXPECT_GT(whole, all / 2);
}

// Tiles need the box that the target's pixels lie in. The patch's corners say it: as far as it is turned, and as far as
// a tilt widens one of its edges. Its middle is on a pixel, so that the box is no larger by chance.
TEST(Tiles, SameBitsWhereTurnsAndTiltsReach) {
  const Targets targets(kWidth, kHeight, 240, true);
  const Patch patch(101, 61, Order::rows, 9);
  tp::PhotometricInput in = input_of(patch);
  in.target_camera.cx = 105;
  in.target_camera.cy = 86;
  Prepared prepared(in);
  const double turns[][3] = {{0, 0, 0.12}, {0, 0, -0.12},   {0.4, 0, 0},       {-0.4, 0, 0},      {0, 0.4, 0},
                             {0, -0.4, 0}, {0.3, 0.2, 0.1}, {-0.3, 0.2, -0.1}, {0.3, -0.2, -0.1}, {-0.3, -0.2, 0.1}};
  for (const tp::simd::Target target : testable_targets()) {
    const TargetScope scope(target);
    SCOPED_TRACE(tp::simd::to_string(target));
    for (const auto& turn : turns) {
      tp::SE3d T;
      T.R = tp::so3_exp<double>({turn[0], turn[1], turn[2]});
      T.t = tp::Vector3<double>(0, 0, 1) - T.R * tp::Vector3<double>(0, 0, 1);
      EXPECT_TRUE(expect_same_of_all(prepared, T, targets)) << turn[0] << ' ' << turn[1];
    }
  }
}

TEST(Tiles, SameBitsBehindALens) {
  const Targets targets(kWidth, kHeight, 240, true);
  const tp::LensMap lens(tp::RadialTangential<double>{{}, -0.2, 0.03, 1e-3, -5e-4, 0});
  const Patch patch(100, 40, Order::rows, 12);
  tp::PhotometricInput in = input_of(patch);
  in.lens = &lens;
  Prepared prepared(in);
  for (const tp::simd::Target target : testable_targets()) {
    const TargetScope scope(target);
    SCOPED_TRACE(tp::simd::to_string(target));
    for (const double angle : {0.0, 0.02, -0.06, 3.1})
      EXPECT_TRUE(expect_same_of_all(prepared, motion(angle, 1, 104.3, 87.8, in), targets)) << angle;
  }
}

// From a patch whose tiles just fit to one that touches the border, and beyond; the image ends, or begins, at a
// forbidden page.
TEST(Tiles, EveryBorder) {
  for (const int stride : {kWidth, 240})
    for (const bool at_end : {false, true}) {
      const Targets targets(kWidth, kHeight, stride, at_end);
      for (const Order order : {Order::rows, Order::reversed, Order::mirrored, Order::upside_down}) {
        const Patch patch(41, 21, order, 7);
        Prepared prepared(input_of(patch));
        for (const tp::simd::Target target : testable_targets()) {
          const TargetScope scope(target);
          SCOPED_TRACE(tp::simd::to_string(target));
          int whole = 0, all = 0;
          for (int side = 0; side < 4; ++side)
            for (double gap = -1.3; gap < 20; gap += gap < 4 ? 0.37 : 1.9) {
              const double across = 21.5 + gap, down = 11.5 + gap;
              const double x = side == 0 ? across : side == 1 ? kWidth - 1 - across : 100.3;
              const double y = side == 2 ? down : side == 3 ? kHeight - 1 - down : 80.7;
              whole += expect_same_of_all(prepared, motion(0.01, 1, x, y, prepared.in), targets);
              ++all;
            }
          EXPECT_GT(whole, all / 2);
          EXPECT_LT(whole, all);
        }
      }
    }
}

// Bounds that lie about the pixels: nothing outside of the image is read, whatever comes of it.
TEST(Tiles, WrongBoundsReadNothingOutside) {
  Patch patch(48, 20, Order::rows, 3);
  tp::PhotometricInput in = input_of(patch);
  in.patch.bounds = tp::simd::point_bounds(in.patch.x, in.patch.y, in.patch.n);
  tp::PhotometricWorkspace workspace(in.patch.n);
  for (const double away : {-1e30, -300.0, -100.0, 100.0, 300.0, 1e30}) {
    for (std::size_t i = 300; i < 600; ++i) patch.x[i] = patch.y[i] = static_cast<float>(away);
    for (const bool at_end : {false, true}) {
      const Targets targets(kWidth, kHeight, kWidth, at_end);
      in.target = targets.near_view();
      for (const tp::simd::Target target : testable_targets()) {
        const TargetScope scope(target);
        const auto e = tp::linearise<tp::Parameters::pose_plane>(
            tp::ResidualRequest{in, {0, 0, 1}, motion(0, 1, 104, 86, in)}, workspace);
        EXPECT_GE(e.visible, 0);
        tp::TemplatePatch prepared;
        ASSERT_EQ(prepared.prepare(in.patch), tp::Status::ok);
        tp::linearise<tp::Parameters::pose_plane>(tp::ResidualRequest{in, {0, 0, 1}, motion(0, 1, 104, 86, in)}.by(
                                                      tp::LinearisePolicy::template_jacobian, &prepared),
                                                  workspace);
      }
    }
  }
}

// The double reference on a dense patch in each direction.
TEST(Tiles, NormalEquationsOfDensePatches) {
  const auto image = texture<std::uint8_t>(kWidth, kHeight, 5);
  for (const Order order : {Order::rows, Order::mirrored, Order::reversed}) {
    Patch patch(50, 20, order, 11);
    tp::PhotometricInput in = input_of(patch);
    in.target = image.view();
    tp::PhotometricWorkspace workspace(in.patch.n);
    const tp::Vector3<double> theta(0, 0, 1);
    for (const double angle : {0.0123, -0.0234, 3.1}) {
      const tp::SE3d T = motion(angle, 1.03, 104.37, 87.81, in);
      for (std::size_t i = 0; i < patch.x.size(); ++i) {
        const tp::Vector3<double> q =
            T.R * in.host_camera.unproject({static_cast<double>(patch.x[i]), static_cast<double>(patch.y[i])}) + T.t;
        const tp::Vector2<double> at = in.target_camera.project(q);
        double value = 0;
        ASSERT_TRUE(tp::sample_bilinear(tp::ImageView8(image.view()), at[0], at[1], &value));
        patch.intensity[i] =
            static_cast<float>(0.8 * value + 15 + (i % 7 == 0 ? 40.0 : 0.0) - static_cast<double>(i % 5));
      }
      for (const auto& o : all_options(15)) {
        const auto reference =
            tp::reference::linearise<tp::Parameters::pose_plane>(tp::ResidualRequest{in, theta, T, o}, workspace);
        for (const tp::simd::Target target : testable_targets()) {
          const TargetScope scope(target);
          SCOPED_TRACE(tp::simd::to_string(target));
          // 1e-3 for the gradients of the few samples that rounding takes across a pixel line.
          expect_close<9>(tp::linearise<tp::Parameters::pose_plane>(tp::ResidualRequest{in, theta, T, o}, workspace),
                          reference, 1e-3);
        }
      }
    }
  }
}

}  // namespace tiles_test
