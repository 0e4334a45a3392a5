// What a camera model is: a struct template of one scalar S, in a file of its own in this folder, that is_camera_model
// accepts. It maps a point p of the camera frame (metres, z forward) to a pixel, and a pixel to a ray. Pixels: the
// centre of the top-left pixel is (0, 0). Most models are a pinhole behind a lens that moves the normalised point
// m = (x/z, y/z) to m_d: pixel = pinhole pixel of m_d.
//
//   kName, kParameters   name of the model; number of parameters: fx fy cx cy (px), then the coefficients of the lens
//   parameters()         the parameters; from_parameters() is its inverse
//   valid()              all parameters are finite and in the model's range, the focal lengths positive
//   in_domain(p)         the model sees p: other points of the domain have other pixels. It ends where p lies behind
//                        the camera or, for a model of wide lenses, at the largest angle from the axis that it has
//   project(p, J_p, J_parameters)
//                        the pixel of p, which must be in the domain. What is not null receives d pixel / d p (2 x 3)
//                        and d pixel / d parameters (2 x kParameters)
//   unproject(px, &m)    the ray m~ = (x/z, y/z, 1) of a pixel. Status::degenerate where there is none or it does not
//                        point forward (z of the unit ray at most 1e-6), non_finite for NaN; m stays as it was
//   unproject_ray(px, &ray)
//                        the same as a unit vector, over the whole domain: z may be zero or negative
//   distort(m, J)        m_d of m, for z > 0; J, unless null, receives d m_d / d m (2 x 2)
//   pinhole()            fx fy cx cy: the camera of the undistorted image. Every kernel takes this one.
//   is_pinhole()         there is nothing to undistort: project() equals pinhole().project()
//   at_level(l)          the camera of pyramid level l, whose pixels are (x + 0.5)/2^l - 0.5
//   cast<U>()            the same of another scalar
//
// None of them throws or allocates. Threads may share a camera. AnyCamera (any_camera.hpp) holds one of them.
#ifndef TEXTPLANE_CORE_CAMERAS_CAMERA_HPP
#define TEXTPLANE_CORE_CAMERAS_CAMERA_HPP

#include <cmath>
#include <type_traits>

#include "textplane/core/numeric.hpp"
#include "textplane/core/status.hpp"

TEXTPLANE_BEGIN_NAMESPACE

template <class S>
struct Pinhole;

/// Whether `Camera` has the members above. Its name is asked for first: S of other templates need be no number.
template <class Camera, class = void>
struct is_camera_model : std::false_type {};
template <template <class> class Model, class S>
struct is_camera_model<
    Model<S>,
    std::void_t<decltype(static_cast<const char*>(Model<S>::kName)),
                decltype(
                    Vector2<S>(Model<S>().project(Vector3<S>(), static_cast<FixedMatrix<S, 2, 3>*>(nullptr),
                                                  static_cast<FixedMatrix<S, 2, Model<S>::kParameters>*>(nullptr))),
                    Status{Model<S>().unproject(Vector2<S>(), static_cast<Vector3<S>*>(nullptr))},
                    Status{Model<S>().unproject_ray(Vector2<S>(), static_cast<Vector3<S>*>(nullptr))},
                    Vector2<S>(Model<S>().distort(Vector2<S>(), static_cast<FixedMatrix<S, 2, 2>*>(nullptr))),
                    Pinhole<S>(Model<S>().pinhole()), Model<S>(Model<S>().at_level(0)),
                    Model<S>::from_parameters(Model<S>().parameters()), Model<S>().template cast<float>(),
                    Model<S>().valid() && Model<S>().is_pinhole() && Model<S>().in_domain(Vector3<S>()))>>
    : std::integral_constant<bool, (Model<S>::kParameters >= 4)> {};

namespace detail {
// The direction of m as a unit vector, and the point (x/z, y/z, 1) of a direction that points forward.
template <class S>
Status bearing_of(const Vector3<S>& m, Vector3<S>* ray) noexcept {
  using std::sqrt;
  const S square = m[0] * m[0] + m[1] * m[1] + m[2] * m[2];
  if (!is_finite(square) || !(square > S(0))) return Status::degenerate;
  const S inverse = S(1) / sqrt(square);
  *ray = {m[0] * inverse, m[1] * inverse, m[2] * inverse};
  return Status::ok;
}
template <class S>
Status point_of(const Vector3<S>& ray, Vector3<S>* m) noexcept {
  if (!(ray[2] > S(1e-6))) return Status::degenerate;
  *m = {ray[0] / ray[2], ray[1] / ray[2], S(1)};
  return Status::ok;
}

}  // namespace detail

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_CORE_CAMERAS_CAMERA_HPP
