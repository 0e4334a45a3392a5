// Lenses of every model, for the tests of kernels behind them.
#ifndef TEXTPLANE_TESTS_SIMD_LENS_CASES_HPP
#define TEXTPLANE_TESTS_SIMD_LENS_CASES_HPP

#include <vector>

#include "textplane/core/cameras/lens_map.hpp"
#include "textplane/simd/lens.hpp"

namespace textplane_test {
// Positions behind a lens are good to twice what they are without (simd/lens.hpp).
constexpr double kLensFactor = 2;

// A lens, and the zoom that lets the patch see as much of it as its fit needs terms for.
struct LensCase {
  const char* name;
  textplane::LensMap lens;
  double zoom;
  int terms;
};
template <class Model>
textplane::LensMap lens_of(const std::vector<double>& coefficients) {
  Eigen::Matrix<double, Model::kParameters, 1> p;
  p.template head<4>() << 1, 1, 0, 0;
  for (int k = 4; k < Model::kParameters; ++k) p[k] = coefficients[static_cast<std::size_t>(k - 4)];
  return textplane::LensMap(Model::from_parameters(p));
}
inline std::vector<LensCase> lens_cases() {
  return {
      {"radial", lens_of<textplane::RadialTangential<double>>({-0.28, 0.07, 0, 0, 0}), 0.8, 3},
      {"radial-tangential", lens_of<textplane::RadialTangential<double>>({-0.28, 0.07, 2e-3, -1e-3, 0.01}), 0.8, 3},
      {"fisheye", lens_of<textplane::KannalaBrandt<double>>({0.01, -0.003, 0.002, -0.001}), 1.5, 6},
      {"fisheye, wide", lens_of<textplane::KannalaBrandt<double>>({0.01, -0.003, 0.002, -0.001}), 0.3,
       textplane::simd::kLensTerms},
      {"rational", lens_of<textplane::Rational<double>>({0.4, 0.1, 1e-3, -5e-4, 0.01, 0.7, 0.15, 0.02}), 0.8, 6},
      {"double sphere", lens_of<textplane::DoubleSphere<double>>({-0.2, 0.6}), 0.8, 6},
      {"extended unified", lens_of<textplane::ExtendedUnified<double>>({0.6, 1.1}), 0.8, 6},
      {"field of view", lens_of<textplane::Fov<double>>({0.9}), 0.8, 6},
  };
}

}  // namespace textplane_test

#endif  // TEXTPLANE_TESTS_SIMD_LENS_CASES_HPP
