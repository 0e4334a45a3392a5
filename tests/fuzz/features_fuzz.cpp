// Kernels on whole images, any size and stride: corners, halving and warps are the same on every target (warps within a
// group of targets); tracks and patches are finite.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include "fuzz.hpp"
#include "textplane/features/fast.hpp"
#include "textplane/features/klt.hpp"
#include "textplane/features/select.hpp"
#include "textplane/photometry/warp_patch.hpp"

namespace textplane_fuzz {
namespace {

bool same(const std::vector<tp::Corner>& a, const std::vector<tp::Corner>& b) {
  return a.size() == b.size() &&
         std::equal(a.begin(), a.end(), b.begin(), [](const tp::Corner& p, const tp::Corner& q) {
           return p.x == q.x && p.y == q.y && p.score == q.score;
         });
}

void corners(const FuzzImage& image, Input& in) {
  const int threshold = in.integer(-2, 300);
  const bool suppress = in.flag();
  std::vector<tp::Corner> first;
  bool begun = false;
  on_every_target([&](tp::simd::Target) {
    std::vector<tp::Corner> found;
    tp::detect_fast(image.view(), threshold, suppress, found);
    if (begun) TEXTPLANE_FUZZ_REQUIRE(same(found, first));
    first = std::move(found);
    begun = true;
  });
}

void pyramids(const FuzzImage& image) {
  std::vector<std::uint8_t> first;
  on_every_target([&](tp::simd::Target) {
    const tp::Pyramid pyramid(image.view(), 4);
    std::vector<std::uint8_t> all;
    for (int l = 0; l < pyramid.levels(); ++l)
      for (int y = 0; y < pyramid.level(l).height(); ++y)
        for (int x = 0; x < pyramid.level(l).width(); ++x) all.push_back(pyramid.level(l)(x, y));
    if (!first.empty()) TEXTPLANE_FUZZ_REQUIRE(all == first);
    first = std::move(all);
  });
}

void warps(const FuzzImage& image, Input& in) {
  tp::Matrix3<double> H;
  for (int i = 0; i < 9; ++i) H(i / 3, i % 3) = in.number(i % 3 == 2 ? -10 : -2, i % 3 == 2 ? 40 : 2);
  if (in.flag()) {
    H.row(2) << 0, 0, 1;
  }
  const int width = in.integer(0, 40), height = in.integer(0, 20);
  std::vector<float> first[2];
  on_every_target([&](tp::simd::Target target) {
    std::vector<float> out(static_cast<std::size_t>(width * height), -1.0F);
    std::vector<std::uint8_t> bytes(out.size());
    const auto a = tp::warp_patch(image.view(), H, tp::ImageView<float>(out.data(), width, height), 7.0F);
    const auto b = tp::warp_patch(image.view(), H, tp::ImageView<std::uint8_t>(bytes.data(), width, height), 7.0F);
    TEXTPLANE_FUZZ_REQUIRE(a.status == b.status && a.inside == b.inside);
    if (!tp::is_ok(a.status) && a.status != tp::Status::out_of_view) return;
    for (const float value : out) TEXTPLANE_FUZZ_REQUIRE(value >= 0 && value <= 255.01F);
    std::vector<float>& other = first[tp::simd::fused(target) ? 1 : 0];
    if (!other.empty()) TEXTPLANE_FUZZ_REQUIRE(std::memcmp(other.data(), out.data(), out.size() * sizeof(float)) == 0);
    other = std::move(out);
  });
}

void tracks(const FuzzImage& a, const FuzzImage& b, Input& in) {
  const tp::Pyramid from(a.view(), 3), to(b.view(), 3);
  tp::KltOptions options;
  options.radius = in.integer(0, 12);
  options.levels = in.integer(0, 4);
  options.min_zncc = static_cast<float>(in.number(-1, 1));
  options.max_forward_backward = static_cast<float>(in.number(0, 2));
  std::vector<tp::Vector2<float>> px, guess;
  for (int i = 0; i < 5; ++i) {
    px.push_back({static_cast<float>(in.number(-5, 70)), static_cast<float>(in.number(-5, 70))});
    guess.push_back({static_cast<float>(in.number(-5, 70)), static_cast<float>(in.number(-5, 70))});
  }
  on_every_target([&](tp::simd::Target) {
    std::vector<tp::KltResult> results(px.size());
    tp::track_klt(from.view(), to.view(), px.data(), in.flag() ? guess.data() : nullptr, static_cast<int>(px.size()),
                  options, results.data());
    for (const tp::KltResult& r : results)
      TEXTPLANE_FUZZ_REQUIRE(!tp::is_ok(r.status) || (tp::is_finite(r.px.x()) && tp::is_finite(r.px.y()) &&
                                                      r.zncc <= 1.0001F && r.zncc >= -1.0001F));
  });
}

void patches(const FuzzImage& image, Input& in) {
  tp::SelectOptions options;
  options.min_pixels = in.integer(-1, 30);
  options.max_pixels = in.integer(-1, 300);
  options.levels = in.integer(-1, 5);
  options.fast_threshold = in.integer(-1, 60);
  const tp::Pyramid pyramid(image.view(), 4);
  const tp::Pinhole<double> camera = in.camera(image.width, image.height);
  const tp::TextPatch patch = tp::make_patch(pyramid.view(), camera, in.quad(60, 60), options);
  if (!tp::is_ok(patch.status)) return;
  for (const tp::PatchLevel& level : patch.levels)
    for (std::size_t i = 0; i < level.x.size(); ++i)
      TEXTPLANE_FUZZ_REQUIRE(level.x[i] >= 0 && level.y[i] >= 0 && level.intensity[i] >= 0 &&
                             level.intensity[i] <= 255 && tp::is_finite(level.gx[i]) && tp::is_finite(level.gy[i]));
}

}  // namespace
}  // namespace textplane_fuzz

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace textplane_fuzz;
  Input in(data, size);
  const int what = in.integer(0, 4);
  const FuzzImage image(in, 0, 70);
  if (what == 0) corners(image, in);
  if (what == 1) pyramids(image);
  if (what == 2) warps(image, in);
  if (what == 3) tracks(image, FuzzImage(in, 0, 70), in);
  if (what == 4) patches(image, in);
  return 0;
}
