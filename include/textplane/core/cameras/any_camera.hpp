// AnyCamera: a camera whose model is known when the program runs, as files name it. It holds one of the models of this
// folder; there is no virtual call and no allocation.
//
//   tp::AnyCamera<double> camera = tp::KannalaBrandt<double>{{190, 190, 254, 256}, 0.003, 0.001, -0.002, 0.0002};
//   camera.project(p);
//   camera.visit([](const auto& model) { ... });  // the model itself
#ifndef TEXTPLANE_CORE_CAMERAS_ANY_CAMERA_HPP
#define TEXTPLANE_CORE_CAMERAS_ANY_CAMERA_HPP

#include <cstddef>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>

#include "textplane/core/cameras/double_sphere.hpp"
#include "textplane/core/cameras/extended_unified.hpp"
#include "textplane/core/cameras/fov.hpp"
#include "textplane/core/cameras/kannala_brandt.hpp"
#include "textplane/core/cameras/pinhole.hpp"
#include "textplane/core/cameras/radial_tangential.hpp"
#include "textplane/core/cameras/rational.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// One of the camera models, with the members that core/cameras/camera.hpp says. Parameters come as vectors of as many
/// numbers as the model has, at most kMaxParameters.
template <class S>
class AnyCamera {
 public:
  /// The models, in the order of index().
  using Variant = std::variant<Pinhole<S>, RadialTangential<S>, Rational<S>, KannalaBrandt<S>, DoubleSphere<S>,
                               ExtendedUnified<S>, Fov<S>>;
  static constexpr int kMaxParameters = 12;  ///< Of the model that has most.
  /// Up to 12 numbers, without a heap.
  using Parameters = Eigen::Matrix<S, Eigen::Dynamic, 1, Eigen::ColMajor, kMaxParameters, 1>;
  /// d pixel / d parameters: 2 rows and a column for each.
  using ParameterJacobian = Eigen::Matrix<S, 2, Eigen::Dynamic, Eigen::ColMajor, 2, kMaxParameters>;

  /// A pinhole: fx = fy = 1, cx = cy = 0.
  AnyCamera() = default;
  /// Of a model.
  template <class Model, class = std::enable_if_t<std::is_constructible<Variant, Model>::value &&
                                                  is_camera_model<std::decay_t<Model>>::value>>
  AnyCamera(const Model& model) noexcept : model_(model) {}  // NOLINT: implicit, a model is a camera

  /// The camera of a model's kName and its parameters. Status::invalid_argument for an unknown name, another number of
  /// parameters, or a camera that is not valid(); then `camera` stays as it was.
  static Status make(std::string_view name, const Parameters& parameters, AnyCamera* camera) noexcept {
    return make_first<0>(name, parameters, camera);
  }

  /// f(model), for the one model that this is: f takes any of them, and returns the same type for all.
  template <class F>
  decltype(auto) visit(F&& f) const {
    return std::visit(std::forward<F>(f), model_);
  }
  /// The model, if it is a `Model`, else null.
  template <class Model>
  const Model* get_if() const noexcept {
    return std::get_if<Model>(&model_);
  }
  std::size_t index() const noexcept { return model_.index(); }  ///< Of the model in Variant.
  /// The model's kName.
  const char* name() const noexcept {
    return visit([](const auto& model) noexcept { return std::decay_t<decltype(model)>::kName; });
  }

  /// fx fy cx cy, then the coefficients of the lens.
  Parameters parameters() const noexcept {
    return visit([](const auto& model) noexcept {
      const auto all = model.parameters();
      Parameters out(all.size());
      for (int i = 0; i < all.size(); ++i) out[i] = all[i];
      return out;
    });
  }
  /// Finite, in the model's range, with positive focal lengths.
  bool valid() const noexcept {
    return visit([](const auto& model) noexcept { return model.valid(); });
  }
  /// Whether the model sees p.
  bool in_domain(const Vector3<S>& p) const noexcept {
    return visit([&](const auto& model) noexcept { return model.in_domain(p); });
  }

  /// Pixel of the camera-frame point p, which is in the domain. What is given receives d pixel / d p (2 x 3) and
  /// d pixel / d parameters (2 x as many as parameters() has).
  Vector2<S> project(const Vector3<S>& p, FixedMatrix<S, 2, 3>* J_p = nullptr,
                     ParameterJacobian* J_parameters = nullptr) const noexcept {
    return visit([&](const auto& model) noexcept {
      if (!J_parameters) return model.project(p, J_p);
      constexpr int count = std::decay_t<decltype(model)>::kParameters;
      FixedMatrix<S, 2, count> J;
      const Vector2<S> px = model.project(p, J_p, &J);
      J_parameters->resize(2, count);
      for (int j = 0; j < count; ++j)
        for (int i = 0; i < 2; ++i) (*J_parameters)(i, j) = J(i, j);
      return px;
    });
  }
  /// Ray m~ = (x/z, y/z, 1) of a pixel: see the model.
  Status unproject(const Vector2<S>& px, Vector3<S>* m) const noexcept {
    return visit([&](const auto& model) noexcept { return model.unproject(px, m); });
  }
  /// Unit vector of a pixel's ray: see the model.
  Status unproject_ray(const Vector2<S>& px, Vector3<S>* ray) const noexcept {
    return visit([&](const auto& model) noexcept { return model.unproject_ray(px, ray); });
  }
  /// Distorted normalised point of m = (x/z, y/z), z > 0. If J is given it receives d m_d / d m (2 x 2).
  Vector2<S> distort(const Vector2<S>& m, FixedMatrix<S, 2, 2>* J = nullptr) const noexcept {
    return visit([&](const auto& model) noexcept { return model.distort(m, J); });
  }

  /// fx fy cx cy: the camera of the undistorted image.
  const Pinhole<S>& pinhole() const noexcept {
    return visit([](const auto& model) noexcept -> const Pinhole<S>& { return model.pinhole(); });
  }
  /// Whether the lens distorts nothing.
  bool is_pinhole() const noexcept {
    return visit([](const auto& model) noexcept { return model.is_pinhole(); });
  }

  /// The same camera for pyramid level l.
  AnyCamera at_level(int level) const noexcept {
    return visit([&](const auto& model) noexcept { return AnyCamera(model.at_level(level)); });
  }
  /// The same of another scalar.
  template <class U>
  AnyCamera<U> cast() const noexcept {
    return visit([](const auto& model) noexcept { return AnyCamera<U>(model.template cast<U>()); });
  }

 private:
  template <std::size_t Index>
  static Status make_first(std::string_view name, const Parameters& parameters, AnyCamera* camera) noexcept {
    if constexpr (Index == std::variant_size<Variant>::value) {
      return Status::invalid_argument;
    } else {
      using Model = std::variant_alternative_t<Index, Variant>;
      if (name != Model::kName) return make_first<Index + 1>(name, parameters, camera);
      if (parameters.size() != Model::kParameters) return Status::invalid_argument;
      Eigen::Matrix<S, Model::kParameters, 1> all;
      for (int i = 0; i < Model::kParameters; ++i) all[i] = parameters[i];
      const Model model = Model::from_parameters(all);
      if (!model.valid()) return Status::invalid_argument;
      *camera = model;
      return Status::ok;
    }
  }

  Variant model_;
};

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_CORE_CAMERAS_ANY_CAMERA_HPP
