// Kernels and solvers from many threads, each with a workspace of its own, on one image, one patch and one prepared
// object: the same bits as from one thread. Built with ThreadSanitizer by the preset `tsan`.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstring>
#include <thread>
#include <vector>

#include "textplane/features/fast.hpp"
#include "textplane/features/klt.hpp"
#include "textplane/photometry/residual_policy.hpp"
#include "textplane/photometry/text_batch.hpp"
#include "textplane/photometry/warp_patch.hpp"
#include "textplane/solver/pose.hpp"

namespace tp = textplane;

namespace {

constexpr int kWidth = 200, kHeight = 150, kThreads = 8;

tp::Image<std::uint8_t> texture() {
  tp::Image<std::uint8_t> image(kWidth, kHeight);
  std::uint32_t state = 1;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      state = state * 1664525U + 1013904223U;
      const int bricks = (x / 9) % 2 == 0 && (y / 7) % 2 == 0 ? 60 : 170;
      image(x, y) = static_cast<std::uint8_t>(bricks + static_cast<int>(state >> 28));
    }
  return image;
}

// What the threads share, and only read.
struct Shared {
  tp::Image<std::uint8_t> image = texture();
  tp::Pyramid pyramid{image.view(), 3};
  tp::Pinhole<double> camera{180, 182, 99.5, 74.5};
  tp::Vector3<double> theta{0.05, -0.04, 0.5};
  tp::SE3d T_t_h{tp::so3_exp<double>({0.01, -0.015, 0.02}), {0.03, -0.02, 0.01}};
  tp::TextPatch patch;
  tp::TemplatePatch prepared;  // of its finest level
  std::vector<tp::TextBatchItem> items;
  tp::TextBatch batch;

  Shared() {
    std::vector<std::vector<tp::Vector2<float>>> pixels(3);
    for (int l = 0; l < 3; ++l)
      for (int i = 0; i < 400; ++i)
        pixels[static_cast<std::size_t>(l)].push_back(
            {static_cast<float>((60 + i * 37 % 80) >> l), static_cast<float>((40 + i * 53 % 60) >> l)});
    tp::Quad<double> quad;
    quad.corner = {tp::Vector2<double>(60, 40), tp::Vector2<double>(140, 40), tp::Vector2<double>(140, 100),
                   tp::Vector2<double>(60, 100)};
    patch = tp::patch_from_pixels(pyramid.view(), camera, quad, pixels);
    prepared.prepare(patch.levels[0].view());
    for (int i = 0; i < 20; ++i) {
      tp::PatchView view = patch.levels[0].view();
      view.n = 15 + i;
      view.bounds = {};
      items.push_back({view, camera, theta});
    }
    batch.build(items.data(), static_cast<int>(items.size()));
  }
};

class Bits {
 public:
  template <class T>
  void add(const T* values, std::size_t n) {
    const auto* bytes = reinterpret_cast<const unsigned char*>(values);
    all_.insert(all_.end(), bytes, bytes + n * sizeof(T));
  }
  void add(double value) { add(&value, 1); }
  bool operator==(const Bits& other) const { return all_ == other.all_; }
  std::size_t size() const { return all_.size(); }

 private:
  std::vector<unsigned char> all_;
};

// One of everything; the results' bits.
Bits run(const Shared& s) {
  Bits bits;
  const tp::PhotometricInput in = tp::photometric_input(s.patch, 0, s.pyramid.view(), s.camera);
  tp::PhotometricWorkspace workspace(in.patch.n);
  tp::PhotometricOptions options;
  options.min_visible = 5;
  for (const int pixels : {30, 400}) {
    tp::PhotometricInput part = in;
    part.patch.n = pixels;
    part.patch.bounds = {};
    const auto e =
        tp::linearise<tp::Parameters::pose_plane>(tp::ResidualRequest{part, s.theta, s.T_t_h, options}, workspace);
    EXPECT_TRUE(tp::is_ok(e.status));
    bits.add(e.H.data(), 81);
    bits.add(e.b.data(), 9);
    bits.add(tp::evaluate(tp::ResidualRequest{part, s.theta, s.T_t_h, options}, workspace).cost);
    for (const auto policy : {tp::LinearisePolicy::esm, tp::LinearisePolicy::template_jacobian})
      bits.add(tp::linearise<tp::Parameters::pose>(tp::ResidualRequest{part, s.theta, s.T_t_h, options}.by(policy),
                                                   workspace)
                   .H.data(),
               36);
  }
  const auto hybrid = tp::ResidualRequest{in, s.theta, s.T_t_h, options}.by(tp::LinearisePolicy::hybrid, &s.prepared);
  bits.add(tp::linearise<tp::Parameters::pose>(hybrid, workspace).H.data(), 36);
  tp::TextBatchResult result(s.batch);
  const std::vector<tp::SE3d> poses(s.items.size(), s.T_t_h);
  EXPECT_EQ(tp::linearise_batch<tp::Parameters::pose>(s.batch, s.image.view(), s.camera, poses.data(), options, result),
            tp::Status::ok);
  for (int i = 0; i < s.batch.size(); ++i) bits.add(result.cost(i));

  std::vector<tp::Corner> corners;
  tp::detect_fast(s.image.view(), 15, true, corners);
  EXPECT_FALSE(corners.empty());
  for (const tp::Corner& c : corners) bits.add(static_cast<double>(c.x) + 1000.0 * static_cast<double>(c.y));
  tp::Image<std::uint8_t> warped(40, 20);
  tp::Matrix3<double> H = tp::Matrix3<double>::Identity();
  H(0, 2) = 30.3;
  H(1, 2) = 20.7;
  tp::warp_patch(s.image.view(), H, warped.view(), 0.0F);
  for (int y = 0; y < 20; ++y) bits.add(warped.view().row(y), 40);
  std::vector<tp::Vector2<float>> px;
  for (int i = 0; i < 10; ++i) px.push_back({static_cast<float>(40 + 11 * i), static_cast<float>(50 + 3 * i)});
  std::vector<tp::KltResult> tracks(px.size());
  tp::track_klt(s.pyramid.view(), s.pyramid.view(), px.data(), nullptr, static_cast<int>(px.size()), {}, tracks.data());
  for (const tp::KltResult& t : tracks) bits.add(static_cast<double>(t.px[0]) + static_cast<double>(t.px[1]));

  tp::SE3d start = s.T_t_h;
  start.t *= 0.5;
  const tp::PoseTextTerm term{&s.patch, s.theta, tp::SE3d(), 1};
  tp::PoseWorkspace memory;
  memory.reserve(&term, 1, 0);
  const tp::PoseFit fit = tp::refine_pose(&term, 1, nullptr, 0, s.pyramid.view(), s.camera, start, {}, memory);
  bits.add(fit.T_t_w.t.data(), 3);
  bits.add(fit.T_t_w.R.data(), 9);
  return bits;
}

std::vector<Bits> from_threads(const Shared& shared) {
  std::vector<Bits> results(kThreads);
  std::atomic<int> ready{0};
  std::vector<std::thread> threads;
  for (int i = 0; i < kThreads; ++i)
    threads.emplace_back([&shared, &ready, &results, i] {
      ++ready;
      while (ready < kThreads) std::this_thread::yield();
      for (int turn = 0; turn < 3; ++turn) results[static_cast<std::size_t>(i)] = run(shared);
    });
  for (std::thread& t : threads) t.join();
  return results;
}

// The first calls of all, too: what is chosen on first use is chosen by all of them at once.
TEST(Threads, EachGetsTheBitsThatOneAloneGets) {
  const Shared shared;
  const std::vector<Bits> results = from_threads(shared);
  const Bits alone = run(shared);
  ASSERT_GT(alone.size(), 1000U);
  for (const Bits& bits : results) EXPECT_TRUE(bits == alone);
}

// The sums of one kernel, to the bit.
std::vector<double> sums_of_a_kernel(const Shared& s) {
  tp::PhotometricWorkspace workspace(s.patch.max_pixels());
  const auto n = tp::linearise<tp::Parameters::pose>(
      tp::ResidualRequest{tp::photometric_input(s.patch, 0, s.pyramid.view(), s.camera), s.theta, s.T_t_h}, workspace);
  std::vector<double> sums(n.H.data(), n.H.data() + 36);
  sums.push_back(n.cost);
  return sums;
}

// A call that is under way ends on the target that it began with; nothing is half of one and half of another. (Targets
// sum in another order, so a solver that began on one may end with other bits on the next.)
TEST(Threads, TargetsMayChangeMeanwhile) {
  const Shared shared;
  std::vector<std::vector<double>> of_targets;
  for (int i = 0; i < tp::simd::kTargetCount; ++i)
    if (tp::simd::set_target(static_cast<tp::simd::Target>(i)) == tp::Status::ok)
      of_targets.push_back(sums_of_a_kernel(shared));
  ASSERT_GE(of_targets.size(), 1U);
  std::atomic<bool> done{false};
  std::thread other([&done] {
    for (int i = 0; !done; ++i) tp::simd::set_target(static_cast<tp::simd::Target>(i % tp::simd::kTargetCount));
  });
  from_threads(shared);
  for (int turn = 0; turn < 300; ++turn) {
    const std::vector<double> sums = sums_of_a_kernel(shared);
    EXPECT_NE(std::find(of_targets.begin(), of_targets.end(), sums), of_targets.end()) << turn;
  }
  done = true;
  other.join();
  ASSERT_EQ(tp::simd::set_target(tp::simd::best_target()), tp::Status::ok);
}

}  // namespace
