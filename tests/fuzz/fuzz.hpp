// What the fuzzers share: numbers, images and poses out of the fuzzer's bytes, and the check that ends a run.
//
// A number is tame, within the range that its place asks for, or wild: NaN, an infinity, a zero, or a magnitude at the
// edge of a type. The bytes choose, so the fuzzer finds out what the choice leads to. Bytes that run out read as zero.
#ifndef TEXTPLANE_TESTS_FUZZ_FUZZ_HPP
#define TEXTPLANE_TESTS_FUZZ_FUZZ_HPP

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <vector>

#include "textplane/core/cameras/pinhole.hpp"
#include "textplane/core/image_view.hpp"
#include "textplane/core/se3.hpp"
#include "textplane/geometry/quad.hpp"
#include "textplane/simd/dispatch.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace textplane_fuzz {

namespace tp = textplane;

/// Ends the program where a promise is broken, so that the fuzzer keeps the input.
#define TEXTPLANE_FUZZ_REQUIRE(condition)                                          \
  do {                                                                             \
    if (!(condition)) {                                                            \
      std::fprintf(stderr, "%s:%d: broken: %s\n", __FILE__, __LINE__, #condition); \
      std::abort();                                                                \
    }                                                                              \
  } while (false)

class Input {
 public:
  Input(const std::uint8_t* data, std::size_t size) : next_(data), left_(size) {}

  std::uint8_t byte() {
    if (left_ == 0) return 0;
    --left_;
    return *next_++;
  }
  bool flag() { return (byte() & 1) != 0; }
  int integer(int low, int high) {
    const int bits = byte() | byte() << 8;
    return low + bits % (high - low + 1);
  }
  /// Within [low, high].
  double tame(double low, double high) {
    const int bits = byte() | byte() << 8;
    return low + (high - low) * bits / 65535.0;
  }
  /// Mostly tame: one selector byte in sixteen asks for something else.
  double number(double low, double high) {
    const std::uint8_t selector = byte();
    if (selector < 240) return tame(low, high);
    wild_ = true;
    constexpr double infinity = std::numeric_limits<double>::infinity();
    constexpr std::array<double, 16> values = {std::numeric_limits<double>::quiet_NaN(),
                                               infinity,
                                               -infinity,
                                               0.0,
                                               -0.0,
                                               1e-300,
                                               -1e-300,
                                               1e300,
                                               -1e300,
                                               1e-30,
                                               1e30,
                                               3.4028235e38,
                                               1.17549435e-38,
                                               2147483648.0,
                                               -2147483649.0,
                                               1e-9};
    return values[selector - 240U];
  }
  tp::Vector3<double> vector(double size) { return {number(-size, size), number(-size, size), number(-size, size)}; }
  tp::SE3d pose(double turn, double shift) {
    const tp::Vector3<double> w = vector(turn);
    return {tp::so3_exp<double>(w), vector(shift)};
  }
  tp::Pinhole<double> camera(int width, int height) {
    return {number(20, 120), number(20, 120), number(0, width), number(0, height)};
  }
  tp::Quad<double> quad(double width, double height) {
    tp::Quad<double> quad;
    for (auto& corner : quad.corner) corner = {number(0, width), number(0, height)};
    return quad;
  }
  /// Something other than a tame number was drawn.
  bool wild() const { return wild_; }
  bool empty() const { return left_ == 0; }
  std::vector<std::uint8_t> rest() {
    std::vector<std::uint8_t> bytes(next_, next_ + left_);
    left_ = 0;
    return bytes;
  }

 private:
  const std::uint8_t* next_;
  std::size_t left_;
  bool wild_ = false;
};

/// An image whose memory ends with its last pixel: AddressSanitizer sees what reads on.
struct FuzzImage {
  int width = 0, height = 0, stride = 0;
  std::vector<std::uint8_t> bytes;

  /// A pattern of waves with noise on it, or noise alone.
  FuzzImage(Input& in, int least, int most) {
    width = in.integer(least, most);
    height = in.integer(least, most);
    stride = width + in.integer(0, 7);
    if (width > 0 && height > 0) bytes.resize(static_cast<std::size_t>((height - 1) * stride + width));
    std::uint32_t state = in.byte() * 2654435761U + 1U;
    const int noise = in.integer(0, 255), u = in.integer(1, 40), v = in.integer(1, 40);
    for (std::size_t i = 0; i < bytes.size(); ++i) {
      state = state * 1664525U + 1013904223U;
      const int x = static_cast<int>(i) % stride, y = static_cast<int>(i) / stride;
      const int wave = (x * u + y * v) & 511;
      const int value =
          (wave < 256 ? wave : 511 - wave) * (255 - noise) / 255 + static_cast<int>(state >> 24) * noise / 255;
      bytes[i] = static_cast<std::uint8_t>(value);
    }
  }
  tp::ImageView8 view() const { return {bytes.data(), width, height, stride}; }
};

/// The targets that this machine has, and the one in use put back at the end.
template <class Body>
void on_every_target(const Body& body) {
  const tp::simd::Target former = tp::simd::active_target();
  for (int i = 0; i < tp::simd::kTargetCount; ++i) {
    const auto target = static_cast<tp::simd::Target>(i);
    if (!tp::simd::supported(target)) continue;
    TEXTPLANE_FUZZ_REQUIRE(tp::simd::set_target(target) == tp::Status::ok);
    body(target);
  }
  TEXTPLANE_FUZZ_REQUIRE(tp::simd::set_target(former) == tp::Status::ok);
}

}  // namespace textplane_fuzz

#endif  // TEXTPLANE_TESTS_FUZZ_FUZZ_HPP
