// Text features for the tracker: planes that begin with its own points and that a key frame confirms, and residuals in
// its own Ceres problems of pose and bundle adjustment. This file and the lines of others that end so add them: // text
#pragma once
#include <ceres/problem.h>

#include <set>
#include <tuple>

#include "foreign_tracker/map.hpp"
#include "textplane/adapters/ceres.hpp"
#include "textplane/adapters/sophus.hpp"

namespace foreign {

namespace tp = textplane;

struct TextFeatures {
  tp::Pinhole<double> camera;
  std::vector<std::tuple<Frame*, Eigen::Vector3d, tp::TextPatch>> texts;  // hosts, planes in their frames, pixels
  std::set<MapPoint*> used;                                               // points that were inside a quad

  static auto T_t_h(const Frame& h, const Frame& t) { return tp::adapters::from_sophus(t.T_w_c.inverse() * h.T_w_c); }

  // Texts of a key frame: quads with new points inside, whose plane another key frame confirms.
  void add(Frame& frame, const Frame& other) {
    for (const auto& quad : frame.quads) {
      std::vector<Eigen::Vector3d> inside;
      for (MapPoint* point : frame.points) {
        const Eigen::Vector3d p = point ? frame.T_w_c.inverse() * point->p_w : Eigen::Vector3d(0, 0, -1);
        if (tp::contains(quad, camera.project(p)) && used.insert(point).second) inside.push_back(p);
      }
      const auto patch = tp::make_patch(frame.pyramid, camera, quad);
      const auto plane = tp::plane_from_points(inside);
      const auto fit = tp::align_plane(patch, plane.value, T_t_h(frame, other), other.pyramid, camera);
      const bool ok = inside.size() >= 8 && tp::is_ok(patch.status) && tp::is_ok(fit.status);
      if (ok && fit.zncc > 0.9) texts.emplace_back(&frame, fit.theta, patch);
    }
  }

  // Residuals of the texts that these frames see; the less a text looks as it did, by blur for one, the less it counts.
  void constrain(const std::vector<Frame*>& frames, ceres::Problem& problem) {
    for (auto& [host, theta, patch] : texts)
      for (Frame* frame : frames) {
        const auto input = tp::photometric_input(patch, 0, frame->pyramid, camera);
        tp::PhotometricWorkspace workspace(input.patch.n);
        const auto now = tp::evaluate(tp::ResidualRequest{input, theta, T_t_h(*host, *frame)}, workspace);
        if (frame == host || !tp::is_ok(now.status) || now.zncc < 0.6) continue;
        const tp::adapters::TextCostOptions options{
            {}, tp::Weighting::variance, 1, 0.3, std::min(1.0, 0.045 / (1 - now.zncc))};
        problem.AddResidualBlock(new tp::adapters::TextCost<>(input, options), nullptr, host->T_w_c.data(),
                                 frame->T_w_c.data(), theta.data());
      }
  }
};

}  // namespace foreign
