#include "textplane/core/numeric.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <type_traits>

#include "support/calculus.hpp"
#include "support/dense.hpp"

namespace tp = textplane;
using textplane_test::central_difference;
using textplane_test::Dual;
using textplane_test::dual_derivative;
using textplane_test::Random;
using textplane_test::relative_error;
using textplane_test::tolerance;
using textplane_test::value;
using textplane_test::values;

template class textplane::Ldlt<float, 3>;
template class textplane::Ldlt<double, 6>;
template class textplane::Ldlt<Dual<3>, 3>;
template struct textplane::SymmetricEigen<float, 3>;
template struct textplane::SymmetricEigen<double, 3>;
template struct textplane::SymmetricEigen<Dual<3>, 3>;

namespace numeric_test {

const double kNan = std::nan(""), kInf = std::numeric_limits<double>::infinity();

template <class S>
class Numeric : public testing::Test {};
using Scalars = testing::Types<float, double, Dual<6>>;
TYPED_TEST_SUITE(Numeric, Scalars, );

// What the tests compute themselves is of any size: the compiler then meets each expression of Eigen once.
Eigen::MatrixXd random_matrix(Random& random, int n) {
  Eigen::MatrixXd m(n, n);
  for (int i = 0; i < n * n; ++i) m(i / n, i % n) = random.uniform(-1, 1);
  return m;
}

Eigen::MatrixXd definite_matrix(Random& random, int n) {
  const Eigen::MatrixXd root = random_matrix(random, n);
  return root * root.transpose() + 0.1 * Eigen::MatrixXd::Identity(n, n);
}

Eigen::MatrixXd symmetric_matrix(Random& random, int n) {
  const Eigen::MatrixXd m = random_matrix(random, n);
  return m + m.transpose();
}

// |a b - c|
double product_error(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b, const Eigen::MatrixXd& c) {
  return (a * b - c).norm();
}

template <class S, int N>
void check_ldlt(Random& random) {
  for (int repeat = 0; repeat < 20; ++repeat) {
    const Eigen::MatrixXd full = definite_matrix(random, N);
    Eigen::Matrix<S, N, N> a = full.cast<S>();
    // What lies above the diagonal is never read.
    for (int i = 0; i < N; ++i)
      for (int j = i + 1; j < N; ++j) a(i, j) = S(1e30);
    const tp::Ldlt<S, N> ldlt(a);
    ASSERT_TRUE(ldlt.ok());
    const Eigen::MatrixXd b = random_matrix(random, N).col(0);
    EXPECT_LT(product_error(full, values(ldlt.solve(b.cast<S>())), b), tolerance<S>(1e-4, 1e-12)) << N;
    EXPECT_LT(product_error(full, values(ldlt.inverse()), Eigen::MatrixXd::Identity(N, N)), tolerance<S>(1e-4, 1e-12))
        << N;
  }
}

// A Rows x Columns matrix of random numbers, and its values.
template <class S, int Rows, int Columns>
Eigen::Matrix<S, Rows, Columns> random_fixed(Random& random, Eigen::MatrixXd* same) {
  Eigen::Matrix<S, Rows, Columns> m;
  same->resize(Rows, Columns);
  for (int c = 0; c < Columns; ++c)
    for (int r = 0; r < Rows; ++r) {
      m(r, c) = S(random.uniform(-1, 1));
      (*same)(r, c) = static_cast<double>(value(m(r, c)));
    }
  return m;
}

template <class S, int Rows, int Columns>
void expect_same(const Eigen::Matrix<S, Rows, Columns>& m, const Eigen::MatrixXd& expected, double bound) {
  ASSERT_EQ(expected.rows(), Rows);
  ASSERT_EQ(expected.cols(), Columns);
  for (int c = 0; c < Columns; ++c)
    for (int r = 0; r < Rows; ++r) EXPECT_NEAR(static_cast<double>(value(m(r, c))), expected(r, c), bound);
}

// Inner sizes that are summed in one chain, and, from four on, in two.
template <class S, int Inner, int Rows, int Columns>
void check_products(double bound) {
  Random random(Inner * 100 + Rows * 10 + Columns);
  Eigen::MatrixXd a, b, c;
  const auto A = random_fixed<S, Rows, Inner>(random, &a);
  const auto B = random_fixed<S, Inner, Columns>(random, &b);
  const auto C = random_fixed<S, Inner, Rows>(random, &c);
  expect_same(tp::product(A, B), a * b, bound);
  expect_same(tp::transposed_product(C, B), c.transpose() * b, bound);
  expect_same(tp::transposed(A), a.transpose(), 0);
  expect_same(tp::scaled(S(-3), A), -3 * a, bound);
}

TYPED_TEST(Numeric, WrittenOutProductsAreProducts) {
  using S = TypeParam;
  const double bound = std::is_same<S, float>::value ? 1e-5 : 1e-14;
  check_products<S, 1, 3, 2>(bound);
  check_products<S, 2, 6, 3>(bound);
  check_products<S, 3, 3, 1>(bound);
  check_products<S, 4, 2, 5>(bound);
  check_products<S, 6, 6, 3>(bound);
  check_products<S, 8, 1, 1>(bound);
  Random random(5);
  Eigen::MatrixXd m;
  const auto M = random_fixed<S, 5, 7>(random, &m);
  expect_same(tp::block<2, 4>(M, 3, 1), m.block(3, 1, 2, 4), 0);
}

TYPED_TEST(Numeric, LdltSolves) {
  Random random(1);
  check_ldlt<TypeParam, 1>(random);
  check_ldlt<TypeParam, 2>(random);
  check_ldlt<TypeParam, 3>(random);
  check_ldlt<TypeParam, 6>(random);
  check_ldlt<TypeParam, 9>(random);
}

TYPED_TEST(Numeric, LdltRefusesWhatIsNotPositiveDefinite) {
  using S = TypeParam;
  using M = Eigen::Matrix<S, 3, 3>;
  M a = M::Identity();
  a(1, 1) = S(-1);
  EXPECT_FALSE((tp::Ldlt<S, 3>(a).ok()));
  EXPECT_FALSE((tp::Ldlt<S, 3>(M(M::Zero())).ok()));
  const tp::Vector3<S> v(S(0.3), S(-0.7), S(1.1)), w(S(0.9), S(0.1), S(-0.4));
  EXPECT_FALSE((tp::Ldlt<S, 3>(M(v * v.transpose() + w * w.transpose())).ok())) << "rank 2";
  for (const double bad : {kNan, kInf, -kInf})
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j <= i; ++j) {
        M broken = M::Identity();
        broken(i, j) = S(static_cast<float>(bad));
        EXPECT_FALSE((tp::Ldlt<S, 3>(broken).ok())) << i << j << bad;
      }
}

// The scale of the matrix does not matter, only its shape.
TEST(LdltTest, PivotsAreJudgedRelatively) {
  const Eigen::Matrix3d small = 1e-200 * Eigen::Matrix3d::Identity();
  EXPECT_TRUE((tp::Ldlt<double, 3>(small).ok()));
  Eigen::Matrix3d graded = Eigen::Matrix3d::Identity();
  graded(2, 2) = 1e-30;
  EXPECT_TRUE((tp::Ldlt<double, 3>(graded).ok()));
}

TEST(LdltTest, DualsThroughSolve) {
  Random random(2);
  const Eigen::Matrix3d root = random_matrix(random, 3), base = root * root.transpose() + Eigen::Matrix3d::Identity();
  const Eigen::Vector3d b = random.vector<3>(1);
  // x as a function of six entries of the matrix.
  const auto f = [&](const auto& x) {
    using S = typename std::decay_t<decltype(x)>::Scalar;
    tp::Matrix3<S> a = base.cast<S>();
    int k = 0;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j <= i; ++j) a(i, j) += x[k++];
    return tp::Vector3<S>(tp::Ldlt<S, 3>(a).solve(b.cast<S>()));
  };
  const Eigen::Matrix<double, 6, 1> zero = Eigen::Matrix<double, 6, 1>::Zero();
  EXPECT_LT(relative_error((dual_derivative<3, 6>(f, zero)), (central_difference<3, 6>(f, zero))), 1e-10);
}

template <class S, int N>
void check_eigen(const Eigen::MatrixXd& a) {
  const auto e = tp::symmetric_eigen<S, N>(a.cast<S>());
  const Eigen::MatrixXd vectors = values(e.vectors), eigenvalues = values(e.values);
  const double scale = 1e-250 + a.norm(), bound = tolerance<S>(2e-6, 1e-14);
  EXPECT_LT(product_error(vectors.transpose(), vectors, Eigen::MatrixXd::Identity(N, N)), N * bound);
  EXPECT_LT(product_error(vectors * eigenvalues.col(0).asDiagonal(), vectors.transpose(), a), N * bound * scale);
  EXPECT_LT((eigenvalues - textplane_test::symmetric_eigenvalues(a)).norm(), N * bound * scale);
  for (int i = 0; i + 1 < N; ++i) EXPECT_LE(eigenvalues(i, 0), eigenvalues(i + 1, 0));
}

TYPED_TEST(Numeric, EigenOfRandomMatrices) {
  using S = TypeParam;
  Random random(3);
  for (int repeat = 0; repeat < 50; ++repeat) {
    check_eigen<S, 3>(symmetric_matrix(random, 3));
    check_eigen<S, 6>(symmetric_matrix(random, 6));
    check_eigen<S, 2>(symmetric_matrix(random, 2));
  }
}

TYPED_TEST(Numeric, EigenOfSpecialMatrices) {
  using S = TypeParam;
  const Eigen::Vector3d v(0.25, -0.5, 1.5), w(2, 0.5, -1);
  check_eigen<S, 3>(Eigen::Matrix3d::Zero());
  check_eigen<S, 3>(Eigen::Matrix3d::Identity());
  check_eigen<S, 3>(Eigen::Matrix3d(Eigen::Vector3d(3, -1, 2).asDiagonal()));
  check_eigen<S, 3>(v * v.transpose());
  check_eigen<S, 3>(v * v.transpose() + w * w.transpose());
  check_eigen<S, 3>(Eigen::Matrix3d::Ones());
  check_eigen<S, 3>(Eigen::Matrix3d(1e-12 * v * v.transpose() + w * w.transpose()));
  Eigen::Matrix3d swap = Eigen::Matrix3d::Zero();
  swap(0, 2) = swap(2, 0) = swap(1, 1) = 1;
  check_eigen<S, 3>(swap);
}

// d lambda_i = v_i^T dA v_i. The second matrix is diagonal: its off-diagonal zeros carry derivatives.
TEST(EigenTest, DualsThroughValuesAndVectors) {
  Random random(4);
  const Eigen::Matrix3d root = random_matrix(random, 3);
  for (const Eigen::Matrix3d& base :
       {Eigen::Matrix3d(root + root.transpose()), Eigen::Matrix3d(Eigen::Vector3d(1, 4, 2).asDiagonal())}) {
    const auto perturbed = [&](const auto& x) {
      using S = typename std::decay_t<decltype(x)>::Scalar;
      tp::Matrix3<S> a = base.cast<S>();
      int k = 0;
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j <= i; ++j) {
          a(i, j) += x[k];
          if (i != j) a(j, i) += x[k];
          ++k;
        }
      return a;
    };
    const auto spectrum = [&](const auto& x) {
      using S = typename std::decay_t<decltype(x)>::Scalar;
      return tp::Vector3<S>(tp::symmetric_eigen<S, 3>(perturbed(x)).values);
    };
    // Projectors v v^T: free of the sign of v.
    const auto projector = [&](const auto& x) {
      using S = typename std::decay_t<decltype(x)>::Scalar;
      const auto e = tp::symmetric_eigen<S, 3>(perturbed(x));
      Eigen::Matrix<S, 9, 1> flat;
      for (int c = 0; c < 3; ++c) flat.template segment<3>(3 * c) = e.vectors.col(c) * e.vectors(c == 0 ? 1 : 0, c);
      return flat;
    };
    const Eigen::Matrix<double, 6, 1> zero = Eigen::Matrix<double, 6, 1>::Zero();
    EXPECT_LT(relative_error((dual_derivative<3, 6>(spectrum, zero)), (central_difference<3, 6>(spectrum, zero))),
              1e-9);
    EXPECT_LT(relative_error((dual_derivative<9, 6>(projector, zero)), (central_difference<9, 6>(projector, zero))),
              1e-8);
  }
}

TEST(FiniteTest, DecidesOnTheBits) {
  EXPECT_TRUE(tp::is_finite(0.0));
  EXPECT_TRUE(tp::is_finite(-0.0));
  EXPECT_TRUE(tp::is_finite(std::numeric_limits<double>::max()));
  EXPECT_TRUE(tp::is_finite(std::numeric_limits<double>::lowest()));
  EXPECT_TRUE(tp::is_finite(std::numeric_limits<double>::denorm_min()));
  EXPECT_FALSE(tp::is_finite(kNan));
  EXPECT_FALSE(tp::is_finite(-kNan));
  EXPECT_FALSE(tp::is_finite(kInf));
  EXPECT_FALSE(tp::is_finite(-kInf));
  EXPECT_TRUE(tp::is_finite(std::numeric_limits<float>::max()));
  EXPECT_TRUE(tp::is_finite(std::numeric_limits<float>::denorm_min()));
  EXPECT_FALSE(tp::is_finite(std::numeric_limits<float>::quiet_NaN()));
  EXPECT_FALSE(tp::is_finite(std::numeric_limits<float>::infinity()));
  EXPECT_FALSE(tp::is_finite(-std::numeric_limits<float>::infinity()));
}

TEST(FiniteTest, OtherScalarsBySubtraction) {
  EXPECT_TRUE(tp::is_finite(Dual<2>(3.0, 1)));
  EXPECT_FALSE(tp::is_finite(Dual<2>(kNan)));
  EXPECT_FALSE(tp::is_finite(Dual<2>(kInf)));
}

TEST(FiniteTest, AllFiniteLooksEverywhere) {
  for (int i = 0; i < 6; ++i) {
    Eigen::Matrix<double, 2, 3> m = Eigen::Matrix<double, 2, 3>::Ones();
    EXPECT_TRUE(tp::all_finite(m));
    m(i / 3, i % 3) = i % 2 ? kNan : kInf;
    EXPECT_FALSE(tp::all_finite(m)) << i;
  }
}

}  // namespace numeric_test
