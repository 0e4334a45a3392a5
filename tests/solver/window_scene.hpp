// A known scene for the window solver: cameras on an arc, points, and smooth textures on planes, rendered through their
// homographies.
#ifndef TEXTPLANE_TESTS_SOLVER_WINDOW_SCENE_HPP
#define TEXTPLANE_TESTS_SOLVER_WINDOW_SCENE_HPP

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <random>
#include <vector>

#include "textplane/geometry/homography.hpp"
#include "textplane/solver/window.hpp"

namespace textplane_test {
namespace tp = textplane;

constexpr int kWidth = 320, kHeight = 240;

/// Uniform in [-1, 1], the same on every platform.
class Noise {
 public:
  explicit Noise(unsigned seed) : engine_(seed) {}
  double operator()() { return static_cast<double>(engine_()) / 2147483647.5 - 1; }
  template <int N>
  Eigen::Matrix<double, N, 1> vector() {
    Eigen::Matrix<double, N, 1> v;
    for (int i = 0; i < N; ++i) v[i] = (*this)();
    return v;
  }

 private:
  std::mt19937 engine_;
};

/// A rectangle of texture in the host's px.
struct SceneText {
  int host;
  tp::Vector3<double> theta;
  double x0, y0, x1, y1;
};

inline double texture(double x, double y, int text) {
  return 125 + 45 * std::sin(0.21 * x + 0.3 + text) * std::cos(0.17 * y - 0.2) +
         30 * std::sin(0.09 * x + 0.23 * y + 0.7 * text) + 20 * std::cos(0.31 * y - 0.05 * x);
}

/// The truth and what is rendered from it. The Window points into it.
struct WindowScene {
  tp::Pinhole<double> camera{260, 262, 161.3, 118.6};
  const tp::LensMap* lens = nullptr;  // of all frames; texts are given in px of the undistorted image
  tp::CameraView view() const { return {camera, lens}; }
  std::vector<tp::SE3d> T_w_c;
  std::vector<SceneText> texts;
  std::vector<std::unique_ptr<tp::Pyramid>> pyramids;
  std::vector<std::unique_ptr<tp::TextPatch>> patches;
  tp::Window truth;

  /// Frame f sits on an arc of radius 4 about the point (0, 0, 4) and looks at it, with some roll.
  void add_frames(int n, double spacing = 0.06) {
    for (int f = 0; f < n; ++f) {
      const double a = spacing * f;
      tp::SE3d T;
      T.R = tp::so3_exp<double>({0, -a, 0}) * tp::so3_exp<double>({0.02 * std::sin(2.0 * f), 0, 0.03 * f});
      T.t = tp::Vector3<double>(4 * std::sin(a), 0.1 * std::cos(1.7 * f), 4 - 4 * std::cos(a));
      T_w_c.push_back(T);
    }
  }

  /// n points in the view, observed by every frame that sees them.
  void add_points(int n, Noise& noise) {
    for (int p = 0; p < n; ++p)
      truth.points.push_back(
          {tp::Vector3<double>(1.2 * noise(), 0.9 * noise(), 4 + 1.2 * noise()), false, tp::Status::ok});
  }

  tp::Window& finish() {
    truth.camera = view();
    render();
    for (std::size_t f = 0; f < T_w_c.size(); ++f) {
      tp::WindowFrame frame;
      frame.T_w_c = T_w_c[f];
      if (!pyramids.empty()) frame.image = pyramids[f]->view();
      truth.frames.push_back(frame);
    }
    for (int f = 0; f < static_cast<int>(T_w_c.size()); ++f)
      for (int p = 0; p < static_cast<int>(truth.points.size()); ++p) {
        const auto c = T_w_c[static_cast<std::size_t>(f)].inverse() * truth.points[static_cast<std::size_t>(p)].p_w;
        if (c[2] < 0.1 || !view().in_domain(c)) continue;
        const tp::Vector2<double> px = view().project(c);
        if (px[0] < 0 || px[1] < 0 || px[0] > kWidth - 1 || px[1] > kHeight - 1) continue;
        tp::WindowPointObservation o;
        o.frame = f;
        o.point = p;
        o.px = px;
        truth.point_observations.push_back(o);
      }
    for (std::size_t i = 0; i < texts.size(); ++i) {
      tp::WindowText t;
      t.host = texts[i].host;
      t.theta = texts[i].theta;
      t.patch = patches[i].get();
      truth.texts.push_back(t);
      for (int f = 0; f < static_cast<int>(T_w_c.size()); ++f) {
        if (f == t.host) continue;
        tp::WindowTextObservation o;
        o.text = static_cast<int>(i);
        o.frame = f;
        truth.text_observations.push_back(o);
      }
    }
    return truth;
  }

 private:
  void render() {
    if (texts.empty()) return;
    for (std::size_t f = 0; f < T_w_c.size(); ++f) {
      tp::Image<std::uint8_t> image(kWidth, kHeight, 90);
      const double gain = 1 - 0.05 * static_cast<double>(f % 4), bias = 3.0 * static_cast<double>(f % 5);
      for (std::size_t i = 0; i < texts.size(); ++i) {
        const SceneText& t = texts[i];
        const tp::SE3d T = T_w_c[f].inverse() * T_w_c[static_cast<std::size_t>(t.host)];
        const tp::Matrix3<double> back = tp::plane_homography<double>(t.theta, T).inverse();
        for (int y = 0; y < kHeight; ++y)
          for (int x = 0; x < kWidth; ++x) {
            tp::Vector3<double> ray;
            if (!tp::is_ok(view().unproject({static_cast<double>(x), static_cast<double>(y)}, &ray))) continue;
            const tp::Vector3<double> q = back * ray;
            const tp::Vector2<double> host = camera.pixel({q[0] / q[2], q[1] / q[2]});
            // A margin, so that the patch never samples the edge.
            if (host[0] < t.x0 - 8 || host[0] > t.x1 + 8 || host[1] < t.y0 - 8 || host[1] > t.y1 + 8) continue;
            image(x, y) = static_cast<std::uint8_t>(gain * texture(host[0], host[1], static_cast<int>(i)) + bias + 0.5);
          }
      }
      pyramids.push_back(std::make_unique<tp::Pyramid>(image.view(), 3));
    }
    for (const SceneText& t : texts) {
      std::vector<std::vector<tp::Vector2<float>>> pixels(3);
      for (int l = 0; l < 3; ++l) {
        const double k = 1.0 / (1 << l), step = l == 0 ? 3 : 1.5;
        for (double y = t.y0; y <= t.y1; y += step / k)
          for (double x = t.x0; x <= t.x1; x += step / k)
            pixels[static_cast<std::size_t>(l)].push_back({static_cast<float>(std::floor((x + 0.5) * k - 0.5)),
                                                           static_cast<float>(std::floor((y + 0.5) * k - 0.5))});
      }
      // As the image with its lens has them.
      for (std::size_t l = 0; l < 3 && lens; ++l)
        for (tp::Vector2<float>& px : pixels[l])
          px = taken(view().at_level(static_cast<int>(l)), px.cast<double>()).cast<float>();
      tp::Quad<double> quad;
      quad.corner = {tp::Vector2<double>(t.x0, t.y0), tp::Vector2<double>(t.x1, t.y0), tp::Vector2<double>(t.x1, t.y1),
                     tp::Vector2<double>(t.x0, t.y1)};
      for (tp::Vector2<double>& corner : quad.corner)
        if (lens) corner = taken(view(), corner);
      patches.push_back(std::make_unique<tp::TextPatch>(
          tp::patch_from_pixels(pyramids[static_cast<std::size_t>(t.host)]->view(), view(), quad, pixels)));
    }
  }
  static tp::Vector2<double> taken(const tp::CameraView& camera, const tp::Vector2<double>& px) {
    return camera.pixel(camera.pinhole.unproject(px).head<2>());
  }
};

/// Three signs at different depths and slants, hosted by different frames.
inline void add_signs(WindowScene& scene) {
  scene.texts.push_back({0, {0.05, -0.03, 0.26}, 30, 30, 110, 80});
  scene.texts.push_back({1, {-0.06, 0.04, 0.30}, 190, 40, 270, 95});
  scene.texts.push_back({0, {0.02, 0.07, 0.24}, 90, 140, 190, 200});
}

/// Moves free frames by `pose` (length and rad), points by `point`, theta by the relative amount `theta`.
inline void perturb(tp::Window& w, Noise& noise, double pose, double point, double theta) {
  for (tp::WindowFrame& f : w.frames) {
    const tp::Vector6<double> xi = pose * noise.vector<6>();
    if (!f.fixed) f.T_w_c = f.T_w_c * tp::se3_exp(xi);
  }
  for (tp::WindowPoint& p : w.points) p.p_w += point * noise.vector<3>();
  for (tp::WindowText& t : w.texts) t.theta += theta * t.theta.norm() * noise.vector<3>();
}

struct Distance {
  double position = 0, rotation = 0, point = 0, theta = 0;  // The largest of each; theta relative.
};
inline Distance distance(const tp::Window& a, const tp::Window& b) {
  Distance d;
  for (std::size_t i = 0; i < a.frames.size(); ++i) {
    const tp::SE3d T = a.frames[i].T_w_c.inverse() * b.frames[i].T_w_c;
    d.position = std::max(d.position, T.t.norm());
    d.rotation = std::max(d.rotation, tp::so3_log(T.R).norm());
  }
  for (std::size_t i = 0; i < a.points.size(); ++i)
    d.point = std::max(d.point, (a.points[i].p_w - b.points[i].p_w).norm());
  for (std::size_t i = 0; i < a.texts.size(); ++i)
    d.theta = std::max(d.theta, (a.texts[i].theta - b.texts[i].theta).norm() / a.texts[i].theta.norm());
  return d;
}

}  // namespace textplane_test

#endif  // TEXTPLANE_TESTS_SOLVER_WINDOW_SCENE_HPP
