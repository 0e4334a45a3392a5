// Planarity: how far a text is bent, as its images show it. A label round a tin and a carton's edge look like a plane
// from near the host, and like nothing from elsewhere.
//
// The text is cut into parts, each with a plane of its own. What may differ between them is one quadratic form of the
// inverse depth over the text, solved for together with the plane, from all views.
#ifndef TEXTSLAM_TEXT_TEXT_PLANARITY_HPP
#define TEXTSLAM_TEXT_TEXT_PLANARITY_HPP

#include <vector>

#include "textplane/photometry/photometric_workspace.hpp"
#include "textplane/solver/plane.hpp"
#include "textslam/common/geometry.hpp"

namespace textslam {

/// A bend across a text, as the tangent of the turn of its normal from one end to the other; positive where the middle
/// is nearest. Along the lines, and across them.
struct Bend {
  Vec2 value = Vec2::Zero();
  Vec2 sigma = Vec2::Zero();
  /// Of theta, by bends that are larger than the views make likely. Errors that bend a plane turn it as well.
  Eigen::Matrix3d doubt = Eigen::Matrix3d::Zero();
  double explained = 0;  ///< Share of the images' disagreement with the plane that the bend explains.
};

/// The bend of the text in `patch` about the plane `theta`, by targets that hold its pixels on one level
/// (target.patch). `sigmas` of a bend cause no doubt. False where they do not tell. `workspace` is reserved for the
/// patch.
bool bend_of(const textplane::TextPatch& patch, const Vec3& theta, const std::vector<textplane::PlaneTarget>& targets,
             const Pinhole<double>& camera, double sigmas, textplane::PhotometricWorkspace& workspace, Bend* bend);

}  // namespace textslam

#endif  // TEXTSLAM_TEXT_TEXT_PLANARITY_HPP
