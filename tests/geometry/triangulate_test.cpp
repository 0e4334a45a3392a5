#include "textplane/geometry/triangulate.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "support/calculus.hpp"

namespace tp = textplane;
using textplane_test::central_difference;
using textplane_test::Dual;
using textplane_test::dual_derivative;
using textplane_test::Random;
using textplane_test::relative_error;
using textplane_test::tolerance;
using textplane_test::value;
using textplane_test::values;
using Vector3d = Eigen::Vector3d;

#define TEXTPLANE_INSTANTIATE(S)                                                                               \
  template tp::Status tp::triangulate<S>(const tp::Vector3<S>&, const tp::Vector3<S>&, const tp::SE3<S>&,      \
                                         tp::Vector3<S>*, tp::Matrix3<S>*);                                    \
  template tp::Status tp::triangulate_views<S>(const tp::SE3<S>*, const tp::Vector3<S>*, int, tp::Vector3<S>*, \
                                               tp::Matrix3<S>*);
TEXTPLANE_INSTANTIATE(float)
TEXTPLANE_INSTANTIATE(double)
TEXTPLANE_INSTANTIATE(Dual<6>)
#undef TEXTPLANE_INSTANTIATE

namespace triangulate_test {

const double kNan = std::nan("");

template <class S>
class Triangulation : public testing::Test {};
using Scalars = testing::Types<float, double, Dual<6>>;
TYPED_TEST_SUITE(Triangulation, Scalars, );

struct Scene {
  Vector3d p;
  std::vector<tp::SE3d> T_c_w;
  std::vector<Vector3d> m;
};

Scene make_scene(Random& random, int views, double baseline) {
  Scene s;
  s.p = Vector3d(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(2, 5));
  for (int i = 0; i < views; ++i) {
    tp::SE3d T = random.pose(0, 0.2);
    T.t = random.vector<3>(baseline);
    const Vector3d q = T * s.p;
    s.T_c_w.push_back(T);
    s.m.push_back(q / q[2]);
  }
  return s;
}

TYPED_TEST(Triangulation, ExactDataGiveThePointBack) {
  using S = TypeParam;
  Random random(1);
  for (int repeat = 0; repeat < 100; ++repeat) {
    const int n = 2 + repeat % 4;
    const Scene s = make_scene(random, n, 0.5);
    std::vector<tp::SE3<S>> T;
    std::vector<tp::Vector3<S>> m;
    for (std::size_t i = 0; i < s.m.size(); ++i) {
      T.push_back(s.T_c_w[i].cast<S>());
      m.push_back(s.m[i].cast<S>());
    }
    const tp::SE3d T_b_a = s.T_c_w[1] * s.T_c_w[0].inverse();
    const Vector3d ray = T_b_a.R * s.m[0];
    if (std::atan2(ray.cross(s.m[1]).norm(), ray.dot(s.m[1])) < 0.02) continue;  // little parallax
    tp::Vector3<S> p = tp::Vector3<S>::Zero(), p_a = p;
    ASSERT_EQ(tp::triangulate_views(T.data(), m.data(), n, &p), tp::Status::ok) << repeat;
    EXPECT_LT((values(p) - s.p).norm(), tolerance<S>(2e-3, 1e-10));
    ASSERT_EQ(tp::triangulate<S>(m[0], m[1], T_b_a.cast<S>(), &p_a), tp::Status::ok);
    EXPECT_LT((values(p_a) - s.T_c_w[0] * s.p).norm(), tolerance<S>(2e-3, 1e-10));
  }
}

TEST(TriangulationTest, SmallParallaxStillConverges) {
  Random random(2);
  for (int repeat = 0; repeat < 50; ++repeat) {
    const double noise = 1e-4;
    Vector3d p(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(2, 5));
    tp::SE3d T;
    T.R = tp::so3_exp<double>(random.vector<3>(0.1));
    T.t = Vector3d(0.05, 0.02, 0.01);  // about 0.7 degrees
    const Vector3d q = T * p;
    const Vector3d m_a = p / p[2] + noise * Vector3d(random.normal(), random.normal(), 0);
    const Vector3d m_b = q / q[2] + noise * Vector3d(random.normal(), random.normal(), 0);
    Vector3d found = Vector3d::Zero();
    Eigen::Matrix3d covariance;
    ASSERT_EQ(tp::triangulate(m_a, m_b, T, &found, &covariance), tp::Status::ok);
    const auto cost = [&](const Vector3d& x) {
      const Vector3d y = T * x;
      const double sum = (x / x[2] - m_a).squaredNorm() + (y / y[2] - m_b).squaredNorm();
      return Eigen::Matrix<double, 1, 1>(Eigen::Matrix<double, 1, 1>::Constant(sum));
    };
    const Vector3d gradient = central_difference<1, 3>(cost, found, 1e-4).transpose(), step = covariance * gradient / 2;
    EXPECT_LT(step.norm(), 1e-5 * found.norm()) << "not at the minimum of the reprojection error";
  }
}

// The reported covariance against ten thousand noisy draws; see plane_fit_test.cpp for the bounds.
TEST(TriangulationTest, CovarianceIsThatOfNoisyDraws) {
  Random random(3);
  constexpr int kDraws = 10000;
  constexpr double kSigma = 0.001;
  const Scene s = make_scene(random, 4, 0.6);
  Eigen::Matrix3d sample = Eigen::Matrix3d::Zero(), covariance = sample;
  Vector3d exact;
  ASSERT_EQ(tp::triangulate_views(s.T_c_w.data(), s.m.data(), 4, &exact, &covariance), tp::Status::ok);
  covariance *= kSigma * kSigma;
  double mahalanobis = 0;
  for (int draw = 0; draw < kDraws; ++draw) {
    auto m = s.m;
    for (auto& x : m) x += kSigma * Vector3d(random.normal(), random.normal(), 0);
    Vector3d p;
    Eigen::Matrix3d own;
    ASSERT_EQ(tp::triangulate_views(s.T_c_w.data(), m.data(), 4, &p, &own), tp::Status::ok);
    const Vector3d e = p - s.p;
    mahalanobis += e.dot((kSigma * kSigma * own).llt().solve(e)) / kDraws;
    sample += e * e.transpose() / kDraws;
  }
  EXPECT_NEAR(mahalanobis, 3, 0.1);
  const Eigen::Matrix3d L = covariance.llt().matrixL(), inverse = L.inverse(),
                        ratio = inverse * sample * inverse.transpose();
  EXPECT_LT((ratio - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff(), 0.06) << ratio;
}

TEST(TriangulationTest, DualsPassThrough) {
  Random random(4);
  const Scene s = make_scene(random, 3, 0.6);
  const auto f = [&](const auto& delta) {
    using S = typename std::decay_t<decltype(delta)>::Scalar;
    std::vector<tp::SE3<S>> T;
    std::vector<tp::Vector3<S>> m;
    for (std::size_t i = 0; i < 3; ++i) {
      T.push_back(s.T_c_w[i].template cast<S>());
      m.push_back(s.m[i].template cast<S>());
      for (int k = 0; k < 2; ++k) m[i][k] += delta[static_cast<int>(2 * i) + k];
    }
    tp::Vector3<S> p = tp::Vector3<S>::Zero();
    EXPECT_EQ(tp::triangulate_views(T.data(), m.data(), 3, &p), tp::Status::ok);
    return p;
  };
  const Eigen::Matrix<double, 6, 1> zero = Eigen::Matrix<double, 6, 1>::Zero();
  EXPECT_LT(relative_error((dual_derivative<3, 6>(f, zero)), (central_difference<3, 6>(f, zero, 1e-5))), 1e-6);
}

TYPED_TEST(Triangulation, DegenerateViewsAreRefused) {
  using S = TypeParam;
  const tp::Vector3<S> untouched(S(7), S(8), S(9));
  tp::Vector3<S> p = untouched;
  tp::SE3<S> T;
  const tp::Vector3<S> m(S(0.1), S(-0.2), S(1)), other(S(0.11), S(-0.2), S(1));
  EXPECT_EQ(tp::triangulate(m, m, T, &p), tp::Status::degenerate) << "no motion";
  EXPECT_EQ(tp::triangulate(m, other, T, &p), tp::Status::degenerate) << "no baseline, noisy match";
  T.R = tp::so3_exp<S>(tp::Vector3<S>(S(0.1), S(0.2), S(-0.3)));
  const tp::Vector3<S> q = T.R * m;
  EXPECT_EQ(tp::triangulate<S>(m, q / q[2], T, &p), tp::Status::degenerate) << "pure rotation";
  T = tp::SE3<S>();
  T.t[0] = S(0.5);
  EXPECT_EQ(tp::triangulate(m, m, T, &p), tp::Status::degenerate) << "parallel rays";
  T.t[0] = S(-0.5);
  EXPECT_EQ(tp::triangulate(m, tp::Vector3<S>(S(0.3), S(-0.2), S(1)), T, &p), tp::Status::behind_camera)
      << "rays that part";
  EXPECT_EQ(values(p), values(untouched));
}

TEST(TriangulationTest, BrokenInputGivesAStatus) {
  const Vector3d untouched(7, 8, 9), m(0.1, 0.2, 1);
  Vector3d p = untouched;
  tp::SE3d T[2];
  T[1].t[0] = 0.5;
  Vector3d rays[2] = {m, m};
  EXPECT_EQ(tp::triangulate_views(T, rays, 1, &p), tp::Status::too_few);
  EXPECT_EQ(tp::triangulate_views(T, rays, 0, &p), tp::Status::too_few);
  EXPECT_EQ(tp::triangulate_views(T, rays, -1, &p), tp::Status::invalid_argument);
  EXPECT_EQ(tp::triangulate_views<double>(nullptr, rays, 2, &p), tp::Status::invalid_argument);
  EXPECT_EQ(tp::triangulate_views<double>(T, nullptr, 2, &p), tp::Status::invalid_argument);
  EXPECT_EQ(tp::triangulate_views<double>(T, rays, 2, nullptr), tp::Status::invalid_argument);
  rays[1][0] = kNan;
  EXPECT_EQ(tp::triangulate_views(T, rays, 2, &p), tp::Status::non_finite);
  rays[1] = Vector3d::Zero();
  EXPECT_EQ(tp::triangulate_views(T, rays, 2, &p), tp::Status::invalid_argument);
  rays[1] = m;
  T[0].R(1, 1) = std::numeric_limits<double>::infinity();
  EXPECT_EQ(tp::triangulate_views(T, rays, 2, &p), tp::Status::non_finite);
  EXPECT_EQ(p, untouched);
}

}  // namespace triangulate_test
