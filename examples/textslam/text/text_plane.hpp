// Patch and plane of a text: making, refining, moving to another key frame, and comparing with an image.
#ifndef TEXTSLAM_TEXT_TEXT_PLANE_HPP
#define TEXTSLAM_TEXT_TEXT_PLANE_HPP

#include <vector>

#include "textplane/photometry/photometric_workspace.hpp"
#include "textplane/photometry/residual_result.hpp"
#include "textslam/map/map.hpp"

namespace textslam {

/// The pixels of a text with this quad in key frame `id`.
textplane::TextPatch make_text_patch(const Map& map, const Parameters& parameters, int id, const Quad<double>& quad);

/// Refines theta, covariance and ZNCC photometrically against these key frames, from `theta`. False, and the text as it
/// was, where the images agree by less than text_zncc_limit() of `min_zncc` or the plane is implausible.
bool refine_plane(const Map& map, const Parameters& parameters, const std::vector<int>& keyframes, const Vec3& theta,
                  double min_zncc, TextObject& text);

/// One level of the text's patch against an image seen from T_c_w; `shift` as scale_shift() says.
textplane::PhotometricCost compare_text(const Map& map, const TextObject& text, int level, const Pyramid& image,
                                        const SE3d& T_c_w, int shift, textplane::PhotometricWorkspace& workspace);

/// Moves a plane with its covariance between key frames. False, and both as they were, where `to` sees its back.
bool transport_plane(const Map& map, int from, int to, Vec3* theta, Eigen::Matrix3d* covariance);

}  // namespace textslam

#endif  // TEXTSLAM_TEXT_TEXT_PLANE_HPP
