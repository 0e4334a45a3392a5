// Parameters of PlaneTracker, and what it says of a frame.
#ifndef TEXTPLANE_EXAMPLES_PLANE_TRACKER_OPTIONS_HPP
#define TEXTPLANE_EXAMPLES_PLANE_TRACKER_OPTIONS_HPP

#include <cstddef>

#include "planar/appearance.hpp"
#include "planar/parts.hpp"
#include "planar/pose_plane_problem.hpp"
#include "planar/view_search.hpp"
#include "textplane/features/select.hpp"
#include "textplane/solver/gauss_newton.hpp"
#include "textplane/solver/search.hpp"

namespace planar {

namespace tp = textplane;

/// One set of parameters for every video and every image pair.
struct PlaneTrackerOptions {
  tp::SelectOptions select;
  tp::PhotometricOptions photometric;
  tp::SolveOptions solve;
  tp::SearchOptions search;  ///< For the start of a video frame, on grey levels.
  AppearanceOptions appearance;
  double sure = 0.9;           ///< A fit with a lower ZNCC is tried again.
  tp::SearchOptions again;     ///< For the second try, on local contrast.
  int plane_level = 2;         ///< From this level on the plane is free, too.
  double focal = 8;            ///< Of the camera whose axis meets the quad's centre, in units of sqrt(the quad's area).
  double plane = 1e-2;         ///< Weight of the prior that the plane faces the first camera, relative to the data.
  double turn = 0.1;           ///< Weight of the prior on tilt (rad^2): a small quad hardly shows perspective.
  double typical = 0.95;       ///< The weights are for fits of this ZNCC; they grow with 1 - ZNCC,
  double most_noise = 20;      ///< at most by this factor.
  double agree = 0.5;          ///< ZNCC from which on a part of the object agrees with an image (parts.hpp).
  double good = 0.42;          ///< Share of parts that agree times ZNCC: from it on a pose is good.
  double unsure = 0.25;        ///< From it on it is a guess at least; below it the object is lost.
  ViewSearchOptions views;     ///< Where a fit is not good.
  std::size_t remembered = 5;  ///< Views that differ, to find the object again by.
  int parts_level = 3;         ///< From this level on, finer ones included,
  double least_share = 0.3;    ///< where from this share of parts on agree,
  double whole = 0.95;         ///< Where fewer parts agree, these alone are fitted.
  int coarse = 2;              ///< All starts are fitted to this level, and
  std::size_t finalists = 5;   ///< Starts of that search that are fitted to the finest level.

  PlaneTrackerOptions() {
    select.levels = 4;
    select.max_pixels = 1000;
    solve.max_iterations = 30;
    search.level = 3;
    search.radius = 5;
    search.roll = 0.2;
    again.level = 1;
  }
};

/// How far the pose of a frame can be trusted.
enum class Confidence {
  good,    ///< Most parts of the object agree with the image: it is there.
  unsure,  ///< Some do. The pose is the best guess and may be wrong.
  lost,    ///< Hardly any does, anywhere in the image. The pose is that of the last good frame.
};

/// A pose as a fit left it.
struct Fit {
  PlaneState state;
  tp::Status status = tp::Status::too_few;
  double zncc = -1;     ///< Of the pixels that were fitted.
  Agreement agreement;  ///< On the finest level that was fitted.
};

/// Few parts must agree well, many need not.
inline double trust(const Fit& fit) noexcept { return fit.agreement.share * fit.zncc; }

/// The one whose parts agree better.
inline const Fit& better(const Fit& a, const Fit& b) noexcept {
  if (!tp::is_ok(b.status)) return a;
  return !tp::is_ok(a.status) || b.agreement.score > a.agreement.score ? b : a;
}

/// Round a quad, px.
inline Region near(const tp::Quad<double>& last) noexcept {
  const tp::Vector2<double> c = tp::centroid(last);
  const double reach = std::sqrt(std::abs(tp::area(last)));
  return {c[0] - reach, c[1] - reach, c[0] + reach, c[1] + reach};
}

}  // namespace planar

#endif  // TEXTPLANE_EXAMPLES_PLANE_TRACKER_OPTIONS_HPP
