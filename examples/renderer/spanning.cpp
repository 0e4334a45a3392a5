#include "renderer/spanning.hpp"

#include <algorithm>
#include <cmath>

#include "renderer/ray_caster.hpp"
#include "renderer/truth.hpp"

namespace textslam {

namespace {

constexpr double kLeastOff = 0.25;  // of its length: how far each side is off the plane of the other
constexpr int kTries = 4000;

/// Where the camera sees the place, if it sees all of its corners and a detector could find it.
bool shows(const SpanningPlace& place, const Scene& scene, const CameraModel& camera, const SE3d& T_w_c, double time,
           Quad<double>* quad) {
  const SE3d T_c_w = T_w_c.inverse();
  SignView view;
  view.visible = view.cosine = 1.0;
  for (std::size_t k = 0; k < 4; ++k) {
    if (!sees(scene, camera, T_w_c, T_c_w, place[k], time)) return false;
    project(camera, T_c_w, place[k], &view.quad.corner[k]);
  }
  *quad = view.quad;
  return textplane::is_convex(*quad) && is_legible(view);
}

/// What the quad's corners lie on, if that is two planes that stand.
bool span(const Quad<double>& quad, const Scene& scene, const CameraModel& camera, const SE3d& T_w_c, double time,
          SpanningPlace* place) {
  const Surface* on[4];
  for (std::size_t k = 0; k < 4; ++k) {
    Vector3<double> ray;
    if (!ray_of(camera, quad.corner[k], &ray)) return false;
    const Vector3<double> direction = T_w_c.R * ray;
    const Hit hit = scene.first_hit(T_w_c.t, direction, time);
    if (hit.surface < 0) return false;
    on[k] = &scene.surfaces()[static_cast<std::size_t>(hit.surface)];
    (*place)[k] = T_w_c.t + hit.distance * direction;
  }
  if (on[0] != on[3] || on[1] != on[2] || on[0]->carrier || on[1]->carrier) return false;
  const double length = ((*place)[1] - (*place)[0]).norm();
  const auto off = [&](const Surface& plane, std::size_t k) {
    return std::abs(plane.rectangle.normal().dot((*place)[k] - plane.rectangle.corner)) >= kLeastOff * length;
  };
  return off(*on[0], 1) && off(*on[0], 2) && off(*on[1], 0) && off(*on[1], 3);
}

}  // namespace

std::vector<SpanningPlace> spanning_places(const Shot& shot, const CameraModel& camera, int frames, double interval,
                                           double in_view, std::uint64_t seed) {
  std::vector<SpanningPlace> places;
  Random random(seed);
  double views = 0.0;
  for (int attempt = 0; attempt < kTries && views < in_view * frames; ++attempt) {
    const double time = random.below(frames) * interval;
    const SE3d T_w_c = shot.motion(time);
    const Quad<double> quad = stray_quad(camera, random);
    std::vector<Quad<double>> others;
    for (const SignView& view : views_of_signs(shot.scene, camera, T_w_c, time)) others.push_back(view.quad);
    for (const SpanningPlace& other : places) {
      Quad<double> seen;
      if (shows(other, shot.scene, camera, T_w_c, time, &seen)) others.push_back(seen);
    }
    const auto meets = [&](const Quad<double>& other) { return boxes_meet(quad, other); };
    SpanningPlace place;
    if (std::any_of(others.begin(), others.end(), meets) || !span(quad, shot.scene, camera, T_w_c, time, &place))
      continue;
    places.push_back(place);
    for (int frame = 0; frame < frames; ++frame) {
      const double t = frame * interval;
      Quad<double> seen;
      views += shows(place, shot.scene, camera, shot.motion(t), t, &seen) ? 1.0 : 0.0;
    }
  }
  return places;
}

std::vector<Detection> detect_spanning(const std::vector<SpanningPlace>& places, const Scene& scene,
                                       const CameraModel& camera, const SE3d& T_w_c, double time,
                                       const DetectorErrors& errors, Random random) {
  std::vector<Detection> found;
  for (const SpanningPlace& place : places) {
    Detection d;
    const bool missed = random.chance(errors.missed);
    if (!shows(place, scene, camera, T_w_c, time, &d.quad)) continue;
    d.quad = jittered(d.quad, errors.corner_sigma, random);
    keep_inside(d.quad, camera);
    if (!missed) found.push_back(d);
  }
  return found;
}

}  // namespace textslam
