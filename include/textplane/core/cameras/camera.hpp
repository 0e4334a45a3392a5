// What a camera model is: a struct template of one scalar S, in a file of its own in this folder, that is_camera_model
// accepts. It maps a point p of the camera frame (metres, z forward) to a pixel, and a pixel to the ray m~ = (x/z, y/z,
// 1). Pixels: the centre of the top-left pixel is (0, 0).
//
//   kParameters         number of parameters: fx fy cx cy (px), then the coefficients of the lens
//   parameters()        the parameters; from_parameters() is its inverse
//   valid()             all parameters are finite and the focal lengths positive
//   in_domain(p)        p is in front of the camera, where the lens model has an inverse
//   project(p, J)       the pixel of p, which must be in the domain; J, unless null, receives d pixel / d p (2 x 3)
//   unproject(px, &m)   the ray of a pixel. Status::degenerate where there is none, non_finite for NaN; m stays as it
//                       was
//   pinhole()           the camera of the undistorted image. Every kernel takes this one.
//   is_pinhole()        there is nothing to undistort: project() equals pinhole().project()
//   at_level(l)         the camera of pyramid level l, whose pixels are (x + 0.5)/2^l - 0.5
//
// None of them throws or allocates. Threads may share a camera.
#ifndef TEXTPLANE_CORE_CAMERAS_CAMERA_HPP
#define TEXTPLANE_CORE_CAMERAS_CAMERA_HPP

#include <type_traits>

#include "textplane/core/numeric.hpp"
#include "textplane/core/status.hpp"

TEXTPLANE_BEGIN_NAMESPACE

template <class S>
struct Pinhole;

/// Whether `Camera` has the members above.
template <class Camera, class = void>
struct is_camera_model : std::false_type {};
template <template <class> class Model, class S>
struct is_camera_model<
    Model<S>,
    std::void_t<decltype(Vector2<S>(Model<S>().project(Vector3<S>(), static_cast<FixedMatrix<S, 2, 3>*>(nullptr))),
                         Status{Model<S>().unproject(Vector2<S>(), static_cast<Vector3<S>*>(nullptr))},
                         Pinhole<S>(Model<S>().pinhole()), Model<S>(Model<S>().at_level(0)),
                         Model<S>::from_parameters(Model<S>().parameters()),
                         Model<S>().valid() && Model<S>().is_pinhole() && Model<S>().in_domain(Vector3<S>()))>>
    : std::integral_constant<bool, (Model<S>::kParameters >= 4)> {};

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_CORE_CAMERAS_CAMERA_HPP
