// Laws of solve_window() at drawn windows: steps lower the cost, the unit of length does not matter, and the reduced
// system is the full one.
#include "textplane/solver/window.hpp"

#include <cmath>
#include <memory>
#include <vector>

#include "properties/properties.hpp"
#include "support/calculus.hpp"
#include "support/dense.hpp"
#include "support/random.hpp"

namespace textplane_test {
namespace window_properties {

const tp::Pinhole<double> kCamera{260, 255, 160.3, 118.9};

// A window of points alone: frames that look at a cloud.
tp::Window points_window(bool exact) {
  Random random(seed());
  tp::Window w;
  w.camera = kCamera;
  const int frames = integer(3, 8), points = integer(8, 30);
  for (int f = 0; f < frames; ++f) {
    tp::WindowFrame frame;
    frame.T_w_c = tp::SE3d{tp::so3_exp<double>(random.vector<3>(0.1)), random.vector<3>(0.6)};
    frame.fixed = f < 2;
    w.frames.push_back(frame);
  }
  for (int p = 0; p < points; ++p) {
    tp::WindowPoint point;
    point.p_w = tp::Vector3<double>(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(3, 6));
    point.fixed = random.uniform(0, 1) < 0.1;
    w.points.push_back(point);
  }
  const double noise = exact ? 0 : number(0, 3);
  for (int f = 0; f < frames; ++f)
    for (int p = 0; p < points; ++p) {
      if (random.uniform(0, 1) < 0.25) continue;
      tp::WindowPointObservation o;
      o.frame = f;
      o.point = p;
      o.px = kCamera.project(w.frames[static_cast<std::size_t>(f)].T_w_c.inverse() *
                             w.points[static_cast<std::size_t>(p)].p_w) +
             random.vector<2>(noise);
      o.sigma = random.uniform(0.5, 2);
      w.point_observations.push_back(o);
    }
  for (tp::WindowFrame& f : w.frames)
    if (!f.fixed) f.T_w_c = f.T_w_c * tp::se3_exp<double>(random.vector<6>(0.03));
  for (tp::WindowPoint& p : w.points)
    if (!p.fixed) p.p_w += random.vector<3>(0.1);
  return w;
}

RC_GTEST_PROP(Windows, EveryStepLowersTheCost, ()) {
  const tp::Window start = points_window(false);
  tp::WindowOptions options;
  tp::WindowWorkspace workspace;
  double last = -1;
  int accepted = 0;
  for (int most = 0; most <= 6; ++most) {
    tp::Window w = start;
    options.max_iterations = most;
    const tp::WindowSummary s = tp::solve_window(w, options, workspace);
    RC_PRE((tp::is_ok(s.status) || s.status == tp::Status::diverged));
    RC_ASSERT((s.iterations <= most && s.accepted <= s.iterations && s.accepted >= accepted));
    RC_ASSERT((last < 0 ? s.final_cost == s.initial_cost : s.final_cost <= last));
    if (s.accepted > accepted) RC_ASSERT(s.final_cost < last);
    last = s.final_cost;
    accepted = s.accepted;
    // And it is the cost of what is given back.
    double cost = 0;
    for (const tp::WindowPointObservation& o : w.point_observations)
      if (o.status == tp::Status::ok) cost += options.point_robust.rho(o.chi2);
    RC_ASSERT(std::abs(cost - s.final_cost) <= 1e-9 * (1 + cost));
  }
}

RC_GTEST_PROP(Windows, ExactObservationsLeadToTheTruth, ()) {
  tp::Window w = points_window(true);
  tp::WindowOptions options;
  options.max_iterations = 60;
  options.cost_tolerance = 1e-14;
  options.step_tolerance = 1e-13;
  options.point_robust.kind = tp::RobustKind::l2;
  const tp::WindowSummary s = tp::solve_window(w, options);
  RC_PRE((s.status == tp::Status::converged && s.undetermined == 0));
  RC_ASSERT(s.final_cost < 1e-15 * s.point_observations);
}

RC_GTEST_PROP(Windows, TheUnitOfLengthIsNotSeen, ()) {
  tp::Window a = points_window(false), b = a;
  const double unit = std::ldexp(1.0, integer(-8, 8));
  for (tp::WindowFrame& f : b.frames) f.T_w_c.t *= unit;
  for (tp::WindowPoint& p : b.points) p.p_w *= unit;
  tp::WindowOptions options;
  options.min_depth = 1e-9;
  const tp::WindowSummary s = tp::solve_window(a, options), t = tp::solve_window(b, options);
  RC_ASSERT((s.status == t.status && s.accepted == t.accepted && s.iterations == t.iterations));
  RC_PRE(tp::is_ok(s.status));
  RC_ASSERT(std::abs(s.final_cost - t.final_cost) <= 1e-7 * (s.final_cost + 1e-9));
}

// Random blocks in the pattern of a random window, and the same in a dense matrix.
RC_GTEST_PROP(Windows, TheReducedSystemIsTheFullOne, ()) {
  tp::Window w = points_window(false);
  const tp::WindowOptions options;
  RC_PRE(tp::detail::check_window(w, options) == tp::Status::ok);
  tp::detail::WindowStructure s;
  RC_PRE(s.build(w, options) == tp::Status::ok);
  Random random(seed());
  const int cameras = s.cameras(), size = 6 * cameras + 3 * s.landmarks();
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(size, size);
  Eigen::VectorXd g = Eigen::VectorXd::Zero(size);
  tp::detail::WindowSchur system;
  system.begin(s);
  for (std::size_t k = 0; k < w.point_observations.size(); ++k) {
    if (!s.point_active[k]) continue;
    const int camera = tp::detail::at(s.camera_of_frame, w.point_observations[k].frame),
              point = w.point_observations[k].point;
    const bool free = tp::detail::at(s.landmark_free, point) != 0;
    Eigen::MatrixXd J = Eigen::MatrixXd::Zero(7, size);  // More rows than one point has: the system is regular at once.
    for (int r = 0; r < 7; ++r) {
      if (camera >= 0) J.row(r).segment<6>(6 * camera) = random.vector<6>(1).transpose();
      if (free) J.row(r).segment<3>(6 * cameras + 3 * point) = random.vector<3>(1).transpose();
    }
    const Eigen::VectorXd r = random.vector<7>(1);
    const Eigen::MatrixXd outer = J.transpose() * J;
    const Eigen::VectorXd gradient = J.transpose() * r;
    H += outer;
    g += gradient;
    if (camera >= 0)
      system.add_camera(camera, outer.block<6, 6>(6 * camera, 6 * camera), gradient.segment<6>(6 * camera));
    const int at = 6 * cameras + 3 * point;
    if (free) system.add_landmark(point, outer.block<3, 3>(at, at), gradient.segment<3>(at));
    if (free && camera >= 0) system.add_coupling(s.point_slot[k], outer.block<6, 3>(6 * camera, at));
  }
  for (int i = 0; i + 1 < cameras; ++i) {  // As a text does: two cameras coupled at once.
    Eigen::MatrixXd J = Eigen::MatrixXd::Zero(12, size);
    for (int r = 0; r < 12; ++r) J.row(r).segment<12>(6 * i) = random.vector<12>(1).transpose();
    const Eigen::MatrixXd outer = J.transpose() * J;
    H += outer;
    for (int c = i; c < i + 2; ++c) system.add_camera(c, outer.block<6, 6>(6 * c, 6 * c), tp::Vector6<double>::Zero());
    if (integer(0, 1) == 0)
      system.add_cameras(i, i + 1, outer.block<6, 6>(6 * i, 6 * i + 6));
    else
      system.add_cameras(i + 1, i, outer.block<6, 6>(6 * i + 6, 6 * i));
  }
  const double lambda = integer(0, 3) == 0 ? 0 : std::pow(10.0, number(-8, 3));
  Eigen::MatrixXd damped = H;
  damped.diagonal() *= 1 + lambda;
  for (int i = 0; i < size; ++i)
    if (damped(i, i) == 0) damped(i, i) = 1;  // What is fixed or unused.
  const Eigen::VectorXd step = -dense_solve(damped, g);
  RC_ASSERT(system.reduce(lambda));
  RC_ASSERT(system.solve());
  const double bound = 1e-9 * (1 + step.norm());
  for (int c = 0; c < cameras; ++c) RC_ASSERT((system.camera_step(c) - step.segment<6>(6 * c)).norm() < bound);
  for (int l = 0; l < s.landmarks(); ++l)
    if (tp::detail::at(s.landmark_free, l))
      RC_ASSERT((system.landmark_step(l) - step.segment<3>(6 * cameras + 3 * l)).norm() < bound);
  const double predicted = -g.dot(step) + lambda * step.dot(H.diagonal().cwiseProduct(step));
  RC_ASSERT(std::abs(system.predicted_decrease() - predicted) < 1e-8 * (1 + predicted));
}

}  // namespace window_properties
}  // namespace textplane_test
