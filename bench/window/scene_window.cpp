#include "window/scene_window.hpp"

#include <algorithm>
#include <cmath>

#include "scene.hpp"
#include "support/random.hpp"

namespace textplane_bench {

namespace {

constexpr int kWidth = 640, kHeight = 480;
constexpr double kWall = 3;           // Distance of the walls from the middle of the room, m.
constexpr double kTexels = 160;       // Texture units a metre: about one a pixel.
constexpr double kRadian = 57.29578;  // Degrees.
constexpr double kMargin = 12;        // Of patches in the images, px: more than a start is off.
constexpr double kSeen = 0.5;         // Share of the possible observations that are made.
constexpr int kPixels = 100;          // Of a patch.

// Wall k of four: a frame whose z points out of the room, x along the wall, y down.
tp::Matrix3<double> wall_frame(int k) { return tp::so3_exp<double>({0, 90 * k / kRadian, 0}); }

// The wall that a ray from the middle of the room hits.
int wall_towards(double angle) { return static_cast<int>(std::floor(angle / (90 / kRadian) + 0.5)) & 3; }

class Builder {
 public:
  Builder(const WindowSize& size, tp::Window* window, std::vector<tp::Pyramid>* images,
          std::vector<tp::TextPatch>* patches)
      : size_(size), w_(*window), images_(*images), patches_(*patches), random_(static_cast<unsigned>(size.frames)) {
    step_ = (size.path == Path::walk ? 5.0 : 40.0 / size.frames) / kRadian;
    w_.camera = tp::Pinhole<double>(480, 480, 319.5, 239.5);
    w_.frames.resize(static_cast<std::size_t>(size.frames));
    images_.resize(w_.frames.size());
    patches_.resize(static_cast<std::size_t>(size.texts));
  }

  void build() {
    for (int f = 0; f < size_.frames; ++f) add_frame(f);
    while (static_cast<int>(w_.points.size()) < size_.points) add_point();
    while (static_cast<int>(w_.texts.size()) < size_.texts) add_text();
    disturb();
  }

 private:
  tp::WindowFrame& frame(int f) { return w_.frames[static_cast<std::size_t>(f)]; }

  void add_frame(int f) {
    const double a = step_ * f;
    tp::SE3d T;
    T.R = tp::so3_exp<double>({0, a, 0}) * tp::so3_exp<double>({0.04 * std::sin(0.9 * f), 0, 0.05 * std::sin(1.3 * f)});
    const double radius = 1 + 0.3 * std::sin(0.37 * f);
    T.t = {radius * std::sin(a), 0.25 * std::sin(0.53 * f), radius * std::cos(a)};
    frame(f).T_w_c = T;
    frame(f).fixed = f == 0 || f == 2;
    if (size_.texts > 0) render(f);
    frame(f).image = images_[static_cast<std::size_t>(f)].view();
  }

  // Follows the ray of each pixel to the nearest wall.
  void render(int f) {
    tp::Image<std::uint8_t> image(kWidth, kHeight);
    const tp::SE3d& T = frame(f).T_w_c;
    const double gain = random_.uniform(0.8, 1), bias = random_.uniform(0, 20);
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        const tp::Vector3<double> ray = T.R * w_.camera.unproject({static_cast<double>(x), static_cast<double>(y)});
        const double sx = (ray[0] > 0 ? kWall - T.t[0] : -kWall - T.t[0]) / ray[0];
        const double sz = (ray[2] > 0 ? kWall - T.t[2] : -kWall - T.t[2]) / ray[2];
        const int k = sz < sx ? (ray[2] > 0 ? 0 : 2) : (ray[0] > 0 ? 1 : 3);
        const tp::Vector3<double> p = wall_frame_[k].transpose() * (T.t + std::min(sx, sz) * ray);
        const double noise = 2 * random_.uniform(-1.7, 1.7);
        const double value =
            gain * texture(kTexels * p[0], kTexels * p[1], static_cast<unsigned>(10 * k)) + bias + noise;
        image(x, y) = static_cast<std::uint8_t>(std::clamp(std::floor(value + 0.5), 0.0, 255.0));
      }
    images_[static_cast<std::size_t>(f)].build(image.view(), 1);
  }

  bool chance(double p) { return random_.uniform(0, 1) < p; }

  // A direction that the cameras turn to, rad.
  double somewhere() { return random_.uniform(-0.4, step_ * (size_.frames - 1) + 0.4); }

  bool sees(int f, const tp::Vector3<double>& p_w, tp::Vector2<double>* px) {
    const tp::Vector3<double> p = frame(f).T_w_c.inverse() * p_w;
    if (!(p[2] > 0.3)) return false;
    *px = w_.camera.project(p);
    return (*px)[0] >= kMargin && (*px)[1] >= kMargin && (*px)[0] <= kWidth - 1 - kMargin &&
           (*px)[1] <= kHeight - 1 - kMargin;
  }

  void add_point() {
    const double angle = somewhere(), height = random_.uniform(-1.2, 1.2), depth = random_.uniform(2, kWall);
    const int k = wall_towards(angle);
    tp::WindowPoint point;
    point.p_w = wall_frame_[k] * tp::Vector3<double>(kWall * std::tan(angle - 90 * k / kRadian), height, depth);
    const std::size_t before = w_.point_observations.size();
    for (int f = 0; f < size_.frames; ++f) {
      tp::WindowPointObservation o;
      o.frame = f;
      o.point = static_cast<int>(w_.points.size());
      if (!sees(f, point.p_w, &o.px) || !chance(kSeen)) continue;
      const double size = chance(0.03) ? 15 : 1;
      o.px[0] += size * random_.normal();
      o.px[1] += size * random_.normal();
      w_.point_observations.push_back(o);
    }
    if (w_.point_observations.size() < before + 3)
      w_.point_observations.resize(before);
    else
      w_.points.push_back(point);
  }

  void add_text() {
    const double angle = somewhere();
    const int k = wall_towards(angle);
    const double middle = kWall * std::tan(angle - 90 * k / kRadian), height = random_.uniform(-1, 1);
    if (std::abs(middle) > kWall - 0.4) return;
    tp::Vector3<double> corner[4];
    for (int c = 0; c < 4; ++c)
      corner[c] = wall_frame_[k] * tp::Vector3<double>(middle + (c == 1 || c == 2 ? 0.25 : -0.25),
                                                       height + (c >= 2 ? 0.1 : -0.1), kWall);
    const tp::Vector3<double> outwards = wall_frame_[k].col(2);
    std::vector<int> seen;
    tp::Quad<double> quad, host_quad;
    for (int f = 0; f < size_.frames; ++f) {
      const tp::Vector3<double> ray = (corner[0] - frame(f).T_w_c.t).normalized();
      bool inside = ray.dot(outwards) > 0.5;  // Within 60 degrees of facing it.
      for (int c = 0; c < 4; ++c) inside = inside && sees(f, corner[c], &quad.corner[static_cast<std::size_t>(c)]);
      if (!inside || !chance(kSeen)) continue;
      if (seen.empty()) host_quad = quad;
      seen.push_back(f);
    }
    if (seen.size() < 3) return;

    tp::WindowText text;
    text.host = seen.front();  // As in tracking, where the first frame that sees a text is its host.
    const tp::SE3d& T = frame(text.host).T_w_c;
    text.theta = T.R.transpose() * outwards / (kWall - outwards.dot(T.t));
    tp::TextPatch& patch = patches_[w_.texts.size()];
    patch = tp::patch_from_pixels(images_[static_cast<std::size_t>(text.host)].view(), w_.camera, host_quad,
                                  pixels(host_quad));
    text.patch = &patch;
    for (std::size_t i = 1; i < seen.size(); ++i) {
      tp::WindowTextObservation o;
      o.text = static_cast<int>(w_.texts.size());
      o.frame = seen[i];
      w_.text_observations.push_back(o);
    }
    w_.texts.push_back(text);
  }

  std::vector<std::vector<tp::Vector2<float>>> pixels(const tp::Quad<double>& q) {
    std::vector<std::vector<tp::Vector2<float>>> out(1);
    while (static_cast<int>(out[0].size()) < kPixels) {
      const double u = random_.uniform(0, 1), v = random_.uniform(0, 1);
      const tp::Vector2<double> upper = q.corner[0] + u * (q.corner[1] - q.corner[0]);
      const tp::Vector2<double> lower = q.corner[3] + u * (q.corner[2] - q.corner[3]);
      const tp::Vector2<double> px = upper + v * (lower - upper);
      out[0].push_back({std::round(static_cast<float>(px[0])), std::round(static_cast<float>(px[1]))});
    }
    return out;
  }

  // As far off as a tracker leaves a window: less than 2 px.
  void disturb() {
    for (tp::WindowFrame& f : w_.frames) {
      tp::Vector6<double> xi;
      xi << random_.vector<3>(0.004), random_.vector<3>(0.001);
      if (!f.fixed) f.T_w_c = f.T_w_c * tp::se3_exp(xi);
    }
    for (tp::WindowPoint& p : w_.points) p.p_w += random_.vector<3>(0.05);
    for (tp::WindowText& t : w_.texts) t.theta += t.theta.norm() * random_.vector<3>(0.005);
  }

  const WindowSize size_;
  tp::Window& w_;
  std::vector<tp::Pyramid>& images_;
  std::vector<tp::TextPatch>& patches_;
  textplane_test::Random random_;
  double step_ = 0;
  const tp::Matrix3<double> wall_frame_[4] = {wall_frame(0), wall_frame(1), wall_frame(2), wall_frame(3)};
};

}  // namespace

std::string to_string(Path path) { return path == Path::walk ? "walk" : "stare"; }

SceneWindow::SceneWindow(const WindowSize& size) { Builder(size, &window, &images_, &patches_).build(); }

}  // namespace textplane_bench
