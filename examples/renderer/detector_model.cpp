#include "renderer/detector_model.hpp"

#include <algorithm>
#include <cmath>

namespace textslam {

namespace {

constexpr double kLeastVisible = 0.6;
constexpr double kWholeVisible = 0.97;
constexpr double kLeastHeight = 9.0;  // px
constexpr double kLeastCosine = 0.31;

double side(const Quad<double>& quad, std::size_t a, std::size_t b) { return (quad.corner[a] - quad.corner[b]).norm(); }

std::string read(const std::string& word, bool whole, double right, Random& random) {
  const bool correct = random.chance(right), unread = random.chance(0.5);
  const int place = random.below(static_cast<int>(word.size())), step = 1 + random.below(25);
  if (!whole) return kUnreadText;
  if (correct) return word;
  if (unread) return kUnreadText;
  std::string wrong = word;
  char& letter = wrong[static_cast<std::size_t>(place)];
  letter = static_cast<char>('A' + (letter - 'A' + step) % 26);
  return wrong;
}

}  // namespace

Quad<double> jittered(const Quad<double>& quad, double sigma, Random& random) {
  Quad<double> out = quad;
  for (Vector2<double>& c : out.corner) {
    c[0] += sigma * random.normal();
    c[1] += sigma * random.normal();
  }
  return out;
}

void keep_inside(Quad<double>& quad, const CameraModel& camera) {
  for (Vector2<double>& c : quad.corner) {
    c[0] = std::clamp(c[0], 0.0, camera.width - 1.0);
    c[1] = std::clamp(c[1], 0.0, camera.height - 1.0);
  }
}

Quad<double> stray_quad(const CameraModel& camera, Random& random) {
  const double w = random.uniform(0.06, 0.22) * camera.width, h = w * random.uniform(0.18, 0.45);
  const Vector2<double> centre(random.uniform(0.5 * w, camera.width - 1 - 0.5 * w),
                               random.uniform(0.5 * h, camera.height - 1 - 0.5 * h));
  const double angle = 0.15 * random.normal(), c = std::cos(angle), s = std::sin(angle);
  Quad<double> quad;
  const double x[4] = {-0.5, 0.5, 0.5, -0.5}, y[4] = {-0.5, -0.5, 0.5, 0.5};
  for (std::size_t k = 0; k < 4; ++k) {
    quad.corner[k] = centre + Vector2<double>(c * x[k] * w - s * y[k] * h, s * x[k] * w + c * y[k] * h);
  }
  return quad;
}

bool boxes_meet(const Quad<double>& a, const Quad<double>& b) {
  const auto low = [](const Quad<double>& q) {
    return q.corner[0].cwiseMin(q.corner[1]).cwiseMin(q.corner[2].cwiseMin(q.corner[3])).eval();
  };
  const auto high = [](const Quad<double>& q) {
    return q.corner[0].cwiseMax(q.corner[1]).cwiseMax(q.corner[2].cwiseMax(q.corner[3])).eval();
  };
  return (low(a).array() <= high(b).array()).all() && (low(b).array() <= high(a).array()).all();
}

bool is_legible(const SignView& view) {
  const double height = std::min(side(view.quad, 0, 3), side(view.quad, 1, 2));
  const double width = std::min(side(view.quad, 0, 1), side(view.quad, 3, 2));
  return view.visible >= kLeastVisible && view.cosine >= kLeastCosine && height >= kLeastHeight &&
         width >= kLeastHeight;
}

std::vector<Detection> detect(const std::vector<SignView>& views, const std::vector<Sign>& signs,
                              const CameraModel& camera, const DetectorErrors& errors, Random random) {
  std::vector<Detection> found;
  for (const SignView& view : views) {
    if (!is_legible(view)) continue;
    Detection d;
    const bool missed = random.chance(errors.missed);
    d.quad = jittered(view.quad, errors.corner_sigma, random);
    d.text = read(signs[static_cast<std::size_t>(view.sign)].word, view.visible >= kWholeVisible, errors.words_right,
                  random);
    keep_inside(d.quad, camera);
    if (!missed) found.push_back(d);
  }
  const double whole = std::floor(errors.false_per_frame);
  const int strays = static_cast<int>(whole) + (random.chance(errors.false_per_frame - whole) ? 1 : 0);
  for (int i = 0; i < strays && !signs.empty(); ++i) {
    // Somewhere that is no sign; a picture full of signs gets its stray quad on top of one in the end.
    Quad<double> quad = stray_quad(camera, random);
    for (int attempt = 0; attempt < 50; ++attempt) {
      const bool meets =
          std::any_of(views.begin(), views.end(), [&](const SignView& v) { return boxes_meet(quad, v.quad); });
      if (!meets) break;
      quad = stray_quad(camera, random);
    }
    keep_inside(quad, camera);
    Detection d;
    d.quad = quad;
    found.push_back(d);
  }
  return found;
}

}  // namespace textslam
