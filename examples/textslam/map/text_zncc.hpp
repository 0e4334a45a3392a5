// What ZNCC a view of a text has to reach, by the noise of the images.
#ifndef TEXTSLAM_MAP_TEXT_ZNCC_HPP
#define TEXTSLAM_MAP_TEXT_ZNCC_HPP

#include "textslam/map/map.hpp"

namespace textslam {

/// zncc_limit() of one level of a text's patch in frame `host` and its image in `frame`, by the contrasts that the
/// patch's pixels have in both. `camera` is that of level 0.
double text_zncc_limit(const Parameters& parameters, double limit, const textplane::TextPatch& patch, int level,
                       const Vec3& theta, const Frame& host, const Frame& frame, const SE3d& T_t_h,
                       const Pinhole<double>& camera);

}  // namespace textslam

#endif  // TEXTSLAM_MAP_TEXT_ZNCC_HPP
