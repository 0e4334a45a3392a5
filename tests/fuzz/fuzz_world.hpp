// What the fuzzers of solvers look at: two images, a patch of one of them, and cameras of any model.
#ifndef TEXTPLANE_TESTS_FUZZ_FUZZ_WORLD_HPP
#define TEXTPLANE_TESTS_FUZZ_FUZZ_WORLD_HPP

#include "fuzz.hpp"
#include "textplane/core/cameras/camera_view.hpp"
#include "textplane/features/select.hpp"

namespace textplane_fuzz {

/// Of any model, with parameters that mostly make sense.
inline tp::AnyCamera<double> any_camera(Input& in) {
  const tp::Pinhole<double> pinhole = in.camera(48, 48);
  const auto k = [&in](double size) { return in.number(-size, size); };
  switch (in.integer(0, 6)) {
    case 0: return pinhole;
    case 1: return tp::RadialTangential<double>{pinhole, k(0.5), k(0.3), k(0.01), k(0.01), k(0.1)};
    case 2: {
      Eigen::Matrix<double, 12, 1> p;
      p << pinhole.parameters(), k(1), k(0.5), k(0.01), k(0.01), k(0.1), k(1), k(0.5), k(0.1);
      return tp::Rational<double>::from_parameters(p);
    }
    case 3: return tp::KannalaBrandt<double>{pinhole, k(0.1), k(0.05), k(0.02), k(0.01)};
    case 4: return tp::DoubleSphere<double>{pinhole, k(0.8), in.number(0, 1)};
    case 5: return tp::ExtendedUnified<double>{pinhole, in.number(0, 1), in.number(0.1, 3)};
    default: return tp::Fov<double>{pinhole, in.number(0.05, 3)};
  }
}

struct World {
  FuzzImage host_image, target_image;
  tp::Pyramid host, target;
  tp::Pinhole<double> camera;
  tp::TextPatch patch;
  tp::Vector3<double> theta;

  explicit World(Input& in)
      : host_image(in, 24, 48), target_image(in, 24, 48), host(host_image.view(), 3), target(target_image.view(), 3) {
    camera = in.camera(48, 48);
    tp::SelectOptions options;
    options.max_pixels = 60;
    options.min_pixels = 1;
    options.fast_threshold = 5;
    const double x = in.tame(2, 20), y = in.tame(2, 20), w = in.tame(6, 22), h = in.tame(6, 22);
    tp::Quad<double> quad;
    quad.corner = {tp::Vector2<double>(x, y), tp::Vector2<double>(x + w, y), tp::Vector2<double>(x + w, y + h),
                   tp::Vector2<double>(x, y + h)};
    patch = tp::make_patch(host.view(), camera.valid() ? camera : tp::Pinhole<double>{50, 50, 20, 20}, quad, options);
    theta = {in.number(-0.3, 0.3), in.number(-0.3, 0.3), in.number(0.1, 1)};
  }
};

}  // namespace textplane_fuzz

#endif  // TEXTPLANE_TESTS_FUZZ_FUZZ_WORLD_HPP
