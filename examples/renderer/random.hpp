// Random numbers of the renderer: a small stream and stateless hashes. Every pixel of every frame has its own number,
// whatever thread computes it, and a seed always gives the same bytes.
#ifndef TEXTSLAM_RENDERER_RANDOM_HPP
#define TEXTSLAM_RENDERER_RANDOM_HPP

#include <cmath>
#include <cstdint>

namespace textslam {

/// The finaliser of SplitMix64: a bijection of 64-bit integers that looks random.
constexpr std::uint64_t mix(std::uint64_t z) noexcept {
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31);
}

/// One integer from several, sensitive to their order.
constexpr std::uint64_t hash(std::uint64_t a, std::uint64_t b, std::uint64_t c = 0) noexcept {
  return mix(mix(mix(a + 0x9e3779b97f4a7c15ULL) ^ b) + 0x9e3779b97f4a7c15ULL * (c + 1));
}

/// In [0, 1).
constexpr double unit(std::uint64_t word) noexcept { return static_cast<double>(word >> 11) * 0x1p-53; }

/// Zero mean, unit variance, near normal (sum of four uniform numbers): the noise of one pixel.
constexpr double near_normal(std::uint64_t word) noexcept {
  const std::uint64_t sum =
      (word & 0xffff) + ((word >> 16) & 0xffff) + ((word >> 32) & 0xffff) + ((word >> 48) & 0xffff);
  return (static_cast<double>(sum) / 65536.0 - (2.0 - 2.0 / 65536.0)) * 1.7320508075688772;
}

/// SplitMix64 as a stream.
class Random {
 public:
  explicit Random(std::uint64_t seed) noexcept : state_(mix(seed)) {}

  std::uint64_t word() noexcept { return mix(state_ += 0x9e3779b97f4a7c15ULL); }
  double uniform() noexcept { return unit(word()); }
  double uniform(double low, double high) noexcept { return low + (high - low) * uniform(); }
  /// In [0, n).
  int below(int n) noexcept { return static_cast<int>(uniform() * n); }
  bool chance(double probability) noexcept { return uniform() < probability; }
  /// Standard normal (Box-Muller; one of the pair).
  double normal() noexcept {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
    return radius * std::cos(6.283185307179586 * uniform());
  }

 private:
  std::uint64_t state_;
};

}  // namespace textslam

#endif  // TEXTSLAM_RENDERER_RANDOM_HPP
