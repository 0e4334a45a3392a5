#include "renderer/truth.hpp"

#include <nlohmann/json.hpp>

#include "io/text_file.hpp"
#include "renderer/ray_caster.hpp"

namespace textslam {

namespace {

nlohmann::json as_json(const Vector3<double>& v) { return {v[0], v[1], v[2]}; }

}  // namespace

bool sees(const Scene& scene, const CameraModel& camera, const SE3d& T_w_c, const SE3d& T_c_w, const Vector3<double>& p,
          double time) {
  Vector2<double> px;
  if (!project(camera, T_c_w, p, &px)) return false;
  if (px[0] < 0.0 || px[1] < 0.0 || px[0] > camera.width - 1 || px[1] > camera.height - 1) return false;
  // The sign itself is hit at distance 1; whatever is nearer hides it.
  const Hit hit = scene.first_hit(T_w_c.t, p - T_w_c.t, time);
  return hit.surface < 0 || hit.distance > 1.0 - 1e-6;
}

std::vector<SignView> views_of_signs(const Scene& scene, const CameraModel& camera, const SE3d& T_w_c, double time) {
  constexpr int kColumns = 16, kRows = 6;
  const SE3d T_c_w = T_w_c.inverse();
  std::vector<SignView> views;
  for (const Sign& painted : scene.signs()) {
    const Sign sign = painted.standing(time);
    const Vector3<double> to_eye = T_w_c.t - sign.at(0.5, 0.5);
    SignView view;
    view.sign = sign.id;
    view.cosine = sign.normal.dot(to_eye) / to_eye.norm();
    if (!(view.cosine > 0.0)) continue;
    bool in_front = true;
    for (std::size_t k = 0; k < 4; ++k)
      in_front = in_front && project(camera, T_c_w, sign.corner[k], &view.quad.corner[k]);
    if (!in_front) continue;
    int seen = 0;
    for (int j = 0; j < kRows; ++j) {
      for (int i = 0; i < kColumns; ++i) {
        const Vector3<double> p = sign.at((i + 0.5) / kColumns, (j + 0.5) / kRows);
        seen += sees(scene, camera, T_w_c, T_c_w, p, time) ? 1 : 0;
      }
    }
    if (seen == 0) continue;
    view.visible = static_cast<double>(seen) / (kColumns * kRows);
    views.push_back(view);
  }
  return views;
}

void place_in_rows(const CameraModel& camera, const Motion& motion, const std::vector<Sign>& signs, double time,
                   std::vector<SignView>* views) {
  constexpr int kIterations = 30;  // each leaves a few per cent of the error
  if (!camera.shutter.active()) return;
  for (SignView& view : *views) {
    for (std::size_t k = 0; k < 4; ++k) {
      Vector2<double> px = view.quad.corner[k];
      bool seen = true;
      for (int i = 0; seen && i < kIterations; ++i) {
        const double then = time + camera.shutter.time(px[1]);
        const Sign sign = signs[static_cast<std::size_t>(view.sign)].standing(then);
        seen = project(camera, motion(then).inverse(), sign.corner[k], &px);
      }
      if (seen) view.quad.corner[k] = px;
    }
  }
}

std::string format_truth_quads(const std::vector<SignView>& views, const std::vector<Sign>& signs) {
  std::string text;
  for (const SignView& view : views) {
    for (const Vector2<double>& c : view.quad.corner) text += shortest(c[0]) + ',' + shortest(c[1]) + ',';
    text += signs[static_cast<std::size_t>(view.sign)].word + ',' + std::to_string(view.sign) + ',' +
            shortest(view.visible) + '\n';
  }
  return text;
}

std::string format_signs(const std::vector<Sign>& signs) {
  nlohmann::json list = nlohmann::json::array();
  for (const Sign& sign : signs) {
    if (sign.carrier) continue;
    nlohmann::json corners = nlohmann::json::array();
    for (const Vector3<double>& c : sign.corner) corners.push_back(as_json(c));
    list.push_back({{"id", sign.id},
                    {"text", sign.word},
                    {"corners", corners},
                    {"normal", as_json(sign.normal)},
                    {"radius", sign.radius}});
  }
  return nlohmann::json{{"signs", list}}.dump(1) + '\n';
}

}  // namespace textslam
