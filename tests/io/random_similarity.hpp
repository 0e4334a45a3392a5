// Random vectors and similarities for tests of alignment and evaluation.
#ifndef TESTS_IO_RANDOM_SIMILARITY_HPP
#define TESTS_IO_RANDOM_SIMILARITY_HPP

#include <cmath>
#include <random>

#include "io/evaluate.hpp"

namespace textslam {
namespace random_similarity {

using Vector = Vector3<double>;

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double unit() { return static_cast<double>(engine_()) / 2147483648.0 - 1; }  // [-1, 1)
  Vector vector(double scale) {
    const double x = unit(), y = unit(), z = unit();
    return scale * Vector(x, y, z);
  }
  Similarity similarity() {
    Similarity s;
    s.scale = std::exp(2 * unit());
    s.R = textplane::so3_exp<double>(vector(3));
    s.t = vector(10);
    return s;
  }

 private:
  std::mt19937 engine_;
};

}  // namespace random_similarity
}  // namespace textslam

#endif  // TESTS_IO_RANDOM_SIMILARITY_HPP
