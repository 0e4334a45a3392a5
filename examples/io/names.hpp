// The library's names that the example programs use as their own vocabulary.
#ifndef TEXTSLAM_IO_NAMES_HPP
#define TEXTSLAM_IO_NAMES_HPP

#include "textplane/core/cameras/any_camera.hpp"
#include "textplane/core/image_view.hpp"
#include "textplane/core/row_motion.hpp"
#include "textplane/core/se3.hpp"
#include "textplane/geometry/quad.hpp"

namespace textslam {

using textplane::Image;
using textplane::ImageView;
using textplane::ImageView8;
using textplane::Matrix3;
using textplane::Pinhole;
using textplane::Quad;
using textplane::RadialTangential;
using textplane::SE3d;
using textplane::Vector2;
using textplane::Vector3;

}  // namespace textslam

#endif  // TEXTSLAM_IO_NAMES_HPP
