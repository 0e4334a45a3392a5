// textplane: everything but adapters/, which bring dependencies of their own. Rooms in the order in which they build on
// each other.
#ifndef TEXTPLANE_TEXTPLANE_HPP
#define TEXTPLANE_TEXTPLANE_HPP

#include "textplane/config.hpp"

#include "textplane/core/cameras/pinhole.hpp"
#include "textplane/core/cameras/radial_tangential.hpp"
#include "textplane/core/image_view.hpp"
#include "textplane/core/numeric.hpp"
#include "textplane/core/se3.hpp"
#include "textplane/core/status.hpp"

#include "textplane/geometry/homography.hpp"
#include "textplane/geometry/plane.hpp"
#include "textplane/geometry/plane_fit.hpp"
#include "textplane/geometry/plane_fit_result.hpp"
#include "textplane/geometry/quad.hpp"
#include "textplane/geometry/quad_projection.hpp"
#include "textplane/geometry/triangulate.hpp"

#include "textplane/photometry/blur.hpp"
#include "textplane/photometry/candidates.hpp"
#include "textplane/photometry/linearise_policy.hpp"
#include "textplane/photometry/local_contrast.hpp"
#include "textplane/photometry/patch.hpp"
#include "textplane/photometry/prepared_target.hpp"
#include "textplane/photometry/pyramid.hpp"
#include "textplane/photometry/residual.hpp"
#include "textplane/photometry/residual_autodiff.hpp"
#include "textplane/photometry/residual_passes.hpp"
#include "textplane/photometry/residual_types.hpp"
#include "textplane/photometry/robust.hpp"
#include "textplane/photometry/sample.hpp"
#include "textplane/photometry/template_patch.hpp"
#include "textplane/photometry/text_batch.hpp"
#include "textplane/photometry/warp_patch.hpp"
#include "textplane/photometry/zncc.hpp"

#include "textplane/features/align.hpp"
#include "textplane/features/fast.hpp"
#include "textplane/features/klt.hpp"
#include "textplane/features/point_patch.hpp"
#include "textplane/features/select.hpp"

#include "textplane/solver/block_cholesky.hpp"
#include "textplane/solver/gauss_newton.hpp"
#include "textplane/solver/levels.hpp"
#include "textplane/solver/plane.hpp"
#include "textplane/solver/pose.hpp"
#include "textplane/solver/pose_problem.hpp"
#include "textplane/solver/search.hpp"
#include "textplane/solver/weighting.hpp"
#include "textplane/solver/window.hpp"
#include "textplane/solver/window_problem.hpp"
#include "textplane/solver/window_schur.hpp"
#include "textplane/solver/window_state.hpp"
#include "textplane/solver/window_structure.hpp"
#include "textplane/solver/window_terms.hpp"

#endif  // TEXTPLANE_TEXTPLANE_HPP
