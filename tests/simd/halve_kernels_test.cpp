// Halving on every target: the bytes of the definition, at all widths, strides and alignments, and not a byte beyond.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "support/guarded.hpp"
#include "support/targets.hpp"
#include "textplane/simd/halve.hpp"

namespace halve_kernels_test {

using namespace textplane_test;

std::vector<std::uint8_t> noise(std::size_t size, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<std::uint8_t> bytes(size);
  for (std::uint8_t& b : bytes) b = static_cast<std::uint8_t>(random() % 4 ? random() % 256 : random() % 2 * 255);
  return bytes;
}

// As the definition says, one pixel at a time.
void halve_plainly(const simd::HalveArgs& a) {
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x) {
      const std::uint8_t* p = a.src + 2 * y * a.src_stride + 2 * x;
      const int sum = p[0] + p[1] + p[a.src_stride] + p[a.src_stride + 1];
      a.dst[y * a.dst_stride + x] = static_cast<std::uint8_t>((sum + 2) / 4);
    }
}

TEST(HalveKernel, GivesTheDefinedBytesAtEveryWidthAndAlignment) {
  for (int width = 1; width <= 140; ++width) {
    const int height = 1 + width % 4, shift = width % 7, gap = width % 5;
    const std::ptrdiff_t src_stride = 2 * width + 1 + gap, dst_stride = width + 3 + gap;
    const auto src = noise(static_cast<std::size_t>(src_stride * 2 * height + shift), static_cast<unsigned>(width));
    std::vector<std::uint8_t> expected(static_cast<std::size_t>(dst_stride * height + shift), 171), found;
    halve_plainly({src.data() + shift, src_stride, expected.data() + shift, dst_stride, width, height});
    for (const simd::Target target : testable_targets()) {
      const TargetScope scope(target);
      found.assign(expected.size(), 171);  // gaps between the rows keep it
      simd::halve({src.data() + shift, src_stride, found.data() + shift, dst_stride, width, height});
      ASSERT_EQ(found, expected) << simd::to_string(target) << ", width " << width;
    }
  }
}

TEST(HalveKernel, TouchesNothingBeyondTheImages) {
  for (int width = 1; width <= 140; ++width) {
    const int height = 3;
    const auto size = static_cast<std::size_t>(4 * width * height);
    const Guarded<std::uint8_t> src(size), dst(size / 4);
    const auto pixels = noise(size, 7);
    std::vector<std::uint8_t> expected(size / 4);
    halve_plainly({pixels.data(), 2 * width, expected.data(), width, width, height});
    for (const simd::Target target : testable_targets()) {
      const TargetScope scope(target);
      for (const bool low : {false, true}) {  // against the upper page and the lower one
        std::uint8_t* const from = low ? src.front() : src.data();
        std::uint8_t* const to = low ? dst.front() : dst.data();
        std::copy(pixels.begin(), pixels.end(), from);
        simd::halve({from, 2 * width, to, width, width, height});
        ASSERT_TRUE(std::equal(expected.begin(), expected.end(), to)) << simd::to_string(target) << ", width " << width;
      }
    }
  }
}

TEST(HalveKernel, DoesNothingWithoutRowsOrColumns) {
  for (const simd::Target target : testable_targets()) {
    const TargetScope scope(target);
    simd::halve({nullptr, 0, nullptr, 0, 0, 0});
    std::uint8_t dst = 7;
    const std::uint8_t src[4] = {1, 2, 3, 4};
    simd::halve({src, 2, &dst, 1, 1, 0});
    simd::halve({src, 2, &dst, 1, 0, 1});
    EXPECT_EQ(dst, 7);
  }
}

}  // namespace halve_kernels_test
