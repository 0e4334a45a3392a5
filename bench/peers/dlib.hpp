// dlib's correlation tracker behind plain data: it is built with flags of its own.
#ifndef TEXTPLANE_BENCH_PEERS_DLIB_HPP
#define TEXTPLANE_BENCH_PEERS_DLIB_HPP

#include <cstdint>
#include <memory>

namespace textplane_bench {

/// An image of rows without gaps.
struct DlibImage {
  const std::uint8_t* pixels = nullptr;
  int width = 0, height = 0;
};

/// Sides of an upright box, px.
struct DlibBox {
  double left = 0, top = 0, right = 0, bottom = 0;
};

class __attribute__((visibility("default"))) DlibTracker {
 public:
  /// Learns what the box shows.
  DlibTracker(const DlibImage& image, const DlibBox& box);
  ~DlibTracker();
  DlibTracker(DlibTracker&&) = delete;

  /// Where it finds that near `guess`, at another size too.
  DlibBox update(const DlibImage& image, const DlibBox& guess);

 private:
  struct Kept;
  std::unique_ptr<Kept> kept_;
};

/// As 19.24.0.
__attribute__((visibility("default"))) const char* dlib_version();

}  // namespace textplane_bench

#endif  // TEXTPLANE_BENCH_PEERS_DLIB_HPP
