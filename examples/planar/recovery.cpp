#include "planar/recovery.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <iterator>
#include <vector>

#include "io/input_error.hpp"
#include "planar/plane_tracker.hpp"
#include "renderer/random.hpp"

namespace planar {

namespace {
using textslam::Random;

constexpr int kFollowed = 5;      // frames before what happens
constexpr double kBorder = 0.05;  // of the plane's bounds that a cover reaches beyond them

/// Draws a rectangle of print, dark bars on light ground, over `share` of the quad's bounds from one of four sides.
void draw_cover(const tp::Quad<double>& quad, double share, std::uint64_t seed, tp::Image<std::uint8_t>& image) {
  const auto b = tp::bounds(quad);
  const double w = b.max[0] - b.min[0], h = b.max[1] - b.min[1];
  double x0 = b.min[0] - kBorder * w, x1 = b.max[0] + kBorder * w;
  double y0 = b.min[1] - kBorder * h, y1 = b.max[1] + kBorder * h;
  const double left_out_x = share < 1 ? (1 - share) * w + kBorder * w : 0;
  const double left_out_y = share < 1 ? (1 - share) * h + kBorder * h : 0;
  switch (seed % 4) {
    case 0: x0 += left_out_x; break;
    case 1: x1 -= left_out_x; break;
    case 2: y0 += left_out_y; break;
    default: y1 -= left_out_y;
  }
  for (int y = std::max(static_cast<int>(y0), 0); y < std::min(static_cast<int>(y1), image.height()); ++y)
    for (int x = std::max(static_cast<int>(x0), 0); x < std::min(static_cast<int>(x1), image.width()); ++x) {
      // Cells of 9 x 12 px with a bar across or down each, at random.
      const int u = x - static_cast<int>(x0), v = y - static_cast<int>(y0);
      const std::uint64_t word =
          textslam::hash(seed, static_cast<std::uint64_t>(u / 9), static_cast<std::uint64_t>(v / 12));
      const int at = static_cast<int>(word >> 8 & 7);
      const bool ink = word & 1 ? std::abs(u % 9 - at) < 2 : std::abs(v % 12 - at) < 2;
      image(x, y) = ink ? 60 : 190;
    }
}

/// What is known of a frame: where the plane is, if it was annotated, or that it is hidden.
struct Known {
  const tp::Quad<double>* corners = nullptr;
  bool hidden = false;
};

/// Runs a tracker and keeps count.
class Judge {
 public:
  explicit Judge(PlaneTracker& tracker, Recovery* out) : tracker_(tracker), out_(*out) {}

  /// Tracks one frame. Returns whether the plane was found, for all that is known.
  bool step(const tp::Image<std::uint8_t>& image, const Known& known) {
    const std::clock_t begin = std::clock();
    tracker_.track(image.view());
    const double ms = 1e3 * static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
    const bool good = tracker_.confidence() == Confidence::good;
    out_.slowest = std::max(out_.slowest, ms);
    if (!good) out_.searching += ms, ++out_.searches;
    if (!known.hidden && !known.corners) return false;
    const bool right = !known.hidden && corner_error(tracker_.quad(), *known.corners) <= kFound;
    ++out_.judged;
    out_.good += good;
    out_.wrong += good && !right;
    return good && right;
  }

 private:
  PlaneTracker& tracker_;
  Recovery& out_;
};

/// The annotation of a frame; none where there is none.
Known known(const PlaneVideo& video, int frame) {
  const auto at = video.truth.find(frame);
  return {at == video.truth.end() ? nullptr : &at->second, false};
}

int random_frame(const PlaneVideo& video, int last, Random& random) {
  const auto end = video.truth.upper_bound(last);
  const auto n = std::distance(video.truth.begin(), end);
  if (n < 1) throw textslam::InputError(video.images, 0, "too few frames");
  return std::next(video.truth.begin(), random.below(static_cast<int>(n)))->first;
}
}  // namespace

Recovery cover(const PlaneVideo& video, int trials, int covered, double share, std::uint64_t seed) {
  Recovery out;
  Random random(seed);
  const int last = video.truth.rbegin()->first;
  for (; out.trials < trials; ++out.trials) {
    const int first = random_frame(video, last - kFollowed - covered - kRecoveryFrames, random);
    const std::uint64_t texture = random.word();
    PlaneTracker tracker(video.load(first).view(), video.truth.at(first));
    Judge judge(tracker, &out);
    bool found = false;
    for (int k = 1; k <= kFollowed + covered + kRecoveryFrames && !found; ++k) {
      auto image = video.load(first + k);
      const bool now = k > kFollowed && k <= kFollowed + covered;
      if (now) draw_cover(video.corners(first + k), share, texture, image);
      found = judge.step(image, now && share >= 1 ? Known{nullptr, true} : known(video, first + k)) &&
              k > kFollowed + covered;
    }
    out.found += found;
  }
  return out;
}

Recovery jump(const PlaneVideo& video, int trials, double least, double most, std::uint64_t seed) {
  Recovery out;
  Random random(seed);
  const int last = video.truth.rbegin()->first;
  while (out.trials < trials) {
    const int first = random_frame(video, last - kFollowed - 2, random), from = first + kFollowed;
    const int to = random_frame(video, last, random);
    const double moved = corner_error(video.corners(from), video.corners(to));
    if (to <= from || moved < least || moved > most) continue;
    ++out.trials;
    PlaneTracker tracker(video.load(first).view(), video.truth.at(first));
    Judge judge(tracker, &out);
    for (int n = first + 1; n <= from; ++n) judge.step(video.load(n), known(video, n));
    out.found += judge.step(video.load(to), known(video, to));
  }
  return out;
}

}  // namespace planar
