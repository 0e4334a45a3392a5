// Checks one number of a project that added textplane as a subfolder: rotating about z by 90 degrees takes x to y.
#include <cmath>
#include <cstdio>

#include <textplane/core/se3.hpp>

int main() {
  textplane::Vector6<double> xi;
  xi << 0, 0, 0, 0, 0, std::acos(0.0);
  const textplane::Vector3<double> p = textplane::se3_exp(xi) * textplane::Vector3<double>(1, 0, 0);
  const double error = (p - textplane::Vector3<double>(0, 1, 0)).norm();
  std::printf("error %.3g\n", error);
  return error < 1e-15 ? 0 : 1;
}
