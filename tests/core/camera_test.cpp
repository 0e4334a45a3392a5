// What core/cameras/camera.hpp says of every model. A new model is a line of core/camera_support.hpp and of Models.
#include "textplane/core/cameras/camera.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/camera_support.hpp"
#include "support/calculus.hpp"

namespace tp = textplane;
using textplane_test::central_difference;
using textplane_test::Dual;
using textplane_test::dual_derivative;
using textplane_test::Random;
using textplane_test::relative_error;
using textplane_test::tolerance;
using textplane_test::values;

template struct textplane::Pinhole<float>;
template struct textplane::Pinhole<double>;
template struct textplane::Pinhole<Dual<3>>;

namespace camera_test {

static_assert(!tp::is_camera_model<double>::value && !tp::is_camera_model<tp::Vector2<double>>::value, "");

template <class Model>
class CameraModel : public testing::Test {
  static_assert(tp::is_camera_model<Model>::value, "not what AnyCamera can hold");

 protected:
  // Near the axis and on it, where angles have no derivative, then all over the domain.
  Eigen::Vector3d point(int i, Random& random) const {
    const double near[] = {0, 1e-300, 1e-12, 1e-6, 1e-4, 1e-3, 3e-3, 3.3e-3, 0.01, 0.03};
    const double scale = random.uniform(0.5, 5);
    if (i < 10) return scale * direction(near[i], random.uniform(0, 6));
    return scale * seen_direction(camera, 0.95, random);
  }
  // Over the whole of a 640 x 480 image.
  static Eigen::Vector2d pixel(Random& random) {
    const double x = random.uniform(0, 639);
    return {x, random.uniform(0, 479)};
  }

  static constexpr int kPoints = 60;
  const Model camera = example<Model>();
};
using Models =
    testing::Types<tp::Pinhole<double>, tp::RadialTangential<double>, tp::Rational<double>, tp::KannalaBrandt<double>,
                   tp::DoubleSphere<double>, tp::ExtendedUnified<double>, tp::Fov<double>>;
TYPED_TEST_SUITE(CameraModel, Models, );

TYPED_TEST(CameraModel, ParametersMakeTheSameCamera) {
  const auto p = this->camera.parameters();
  EXPECT_EQ(TypeParam::from_parameters(p).parameters(), p);
  const auto in_float = this->camera.template cast<float>().parameters();
  for (int i = 0; i < TypeParam::kParameters; ++i) EXPECT_EQ(in_float[i], static_cast<float>(p[i]));
  for (int i = 0; i < 4; ++i) EXPECT_EQ(p[i], this->camera.pinhole().parameters()[i]);
}

TYPED_TEST(CameraModel, ValidNeedsFiniteParametersAndPositiveFocalLengths) {
  EXPECT_TRUE(this->camera.valid());
  const double bad[] = {std::nan(""), std::numeric_limits<double>::infinity(), 0.0, -1.0};
  for (int i = 0; i < TypeParam::kParameters; ++i)
    for (int k = 0; k < (i < 4 ? 4 : 2); ++k) {  // the ranges of coefficients: CameraRanges
      auto p = this->camera.parameters();
      p[i] = bad[k];
      EXPECT_EQ(TypeParam::from_parameters(p).valid(), i >= 2 && k >= 2) << i << " " << k;
    }
}

TYPED_TEST(CameraModel, UnprojectInvertsProjectOverTheWholeDomain) {
  Random random(5);
  for (int i = 0; i < 400; ++i) {
    const Eigen::Vector3d unit = i < 10 ? Eigen::Vector3d(this->point(i, random).normalized())
                                        : seen_direction(this->camera, i < 300 ? 0.99 : 0.9999, random);
    const Eigen::Vector3d p = random.uniform(0.1, 9) * unit;
    ASSERT_TRUE(this->camera.in_domain(p));
    const Eigen::Vector2d px = this->camera.project(p);
    Eigen::Vector3d ray(0, 0, 0), m(7, 8, 9);
    ASSERT_EQ(this->camera.unproject_ray(px, &ray), tp::Status::ok) << unit.transpose();
    EXPECT_LT(std::abs(ray.norm() - 1), 1e-14);
    EXPECT_LT((ray - unit).norm(), i < 300 ? 1e-12 : 1e-9) << unit.transpose();
    EXPECT_LT((this->camera.project(ray) - px).norm(), 1e-9 * std::max(1.0, 1e-3 * px.norm())) << unit.transpose();
    const bool forward = unit[2] > 1e-5;
    ASSERT_EQ(this->camera.unproject(px, &m), forward ? tp::Status::ok : tp::Status::degenerate) << unit.transpose();
    if (!forward) {
      EXPECT_EQ(m, Eigen::Vector3d(7, 8, 9));
      continue;
    }
    EXPECT_LT((m - ray / ray[2]).norm(), 1e-12 * m.norm());
    EXPECT_EQ(m[2], 1);
  }
}

TYPED_TEST(CameraModel, DomainEndsBehindTheCamera) {
  EXPECT_TRUE(this->camera.in_domain({0, 0, 1}));
  EXPECT_TRUE(this->camera.in_domain({0, 0, 1e-30}));
  EXPECT_FALSE(this->camera.in_domain({0, 0, 0}));
  EXPECT_FALSE(this->camera.in_domain({0, 0, -1}));
  EXPECT_FALSE(this->camera.in_domain({1e-200, 0, -1})) << "no number squared";
  EXPECT_FALSE(this->camera.in_domain({0, 0, std::nan("")}));
}

TYPED_TEST(CameraModel, UnprojectRefusesWhatIsNoPixel) {
  const Eigen::Vector3d untouched(7, 8, 9);
  Eigen::Vector3d m = untouched;
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    EXPECT_EQ(this->camera.unproject({bad, 0}, &m), tp::Status::non_finite);
    EXPECT_EQ(this->camera.unproject_ray({0, bad}, &m), tp::Status::non_finite);
  }
  EXPECT_FALSE(tp::is_ok(this->camera.unproject_ray({1e200, 1e200}, &m)));
  EXPECT_EQ(m, untouched);
  for (int i = 0; i < TypeParam::kParameters; ++i) {
    auto p = this->camera.parameters();
    p[i] = std::nan("");
    for (const double x : {0.0, 319.5, 1000.0}) {
      EXPECT_FALSE(tp::is_ok(TypeParam::from_parameters(p).unproject_ray({x, 241}, &m)) && !m.allFinite()) << i;
    }
  }
}

TYPED_TEST(CameraModel, DerivativesByThePoint) {
  Random random(2);
  for (int i = 0; i < this->kPoints; ++i) {
    const Eigen::Vector3d p = this->point(i, random);
    Eigen::Matrix<double, 2, 3> J;
    EXPECT_LT((this->camera.project(p, &J) - this->camera.project(p)).norm(), 1e-12);
    const auto f = [&](const auto& x) {
      using S = typename std::decay_t<decltype(x)>::Scalar;
      return tp::Vector2<S>(this->camera.template cast<S>().project(x));
    };
    EXPECT_LT(relative_error(J, (central_difference<2, 3>(f, p, 1e-4 * p.norm()))), 1e-9) << p.transpose();
    EXPECT_LT(relative_error(J, (dual_derivative<2, 3>(f, p))), 1e-12) << p.transpose();
  }
}

TYPED_TEST(CameraModel, DerivativesByTheParameters) {
  constexpr int n = TypeParam::kParameters;
  Random random(3);
  for (int i = 0; i < this->kPoints; ++i) {
    const Eigen::Vector3d p = this->point(i, random);
    Eigen::Matrix<double, 2, 3> J_p, J_p_alone;
    tp::FixedMatrix<double, 2, n> J, J_alone;
    this->camera.project(p, &J_p, &J);
    this->camera.project(p, nullptr, &J_alone);
    this->camera.project(p, &J_p_alone);
    EXPECT_EQ(J, J_alone);
    EXPECT_EQ(J_p, J_p_alone);
    const auto f = [&](const auto& x) {
      using S = typename std::decay_t<decltype(x)>::Scalar;
      using Camera = decltype(this->camera.template cast<S>());
      return tp::Vector2<S>(Camera::from_parameters(x).project(p.template cast<S>()));
    };
    const auto parameters = this->camera.parameters();
    EXPECT_LT(relative_error(J, (dual_derivative<2, n>(f, parameters))), 1e-12) << p.transpose();
    EXPECT_LT(relative_error(J, (central_difference<2, n>(f, parameters))), 1e-9) << p.transpose();
  }
}

TYPED_TEST(CameraModel, DerivativesOfTheLens) {
  Random random(4);
  for (int i = 0; i < this->kPoints; ++i) {
    const Eigen::Vector3d p = this->point(i, random);
    if (p[2] < 0.02) continue;
    const Eigen::Vector2d m = p.hnormalized();
    Eigen::Matrix2d J;
    EXPECT_EQ(this->camera.distort(m, &J), this->camera.distort(m));
    EXPECT_LT((this->camera.pinhole().pixel(this->camera.distort(m)) - this->camera.project(p)).norm(), 1e-11);
    const auto f = [&](const auto& x) {
      using S = typename std::decay_t<decltype(x)>::Scalar;
      return tp::Vector2<S>(this->camera.template cast<S>().distort(x));
    };
    EXPECT_LT(relative_error(J, (dual_derivative<2, 2>(f, m))), 1e-12) << m.transpose();
    EXPECT_LT(relative_error(J, (central_difference<2, 2>(f, m))), 1e-9) << m.transpose();
  }
}

// The way there and back has the identity as its derivative, on the axis too.
TYPED_TEST(CameraModel, UnprojectCarriesDerivatives) {
  Random random(8);
  for (int i = 0; i < this->kPoints; ++i) {
    const Eigen::Vector2d px = this->camera.project(this->point(i, random));
    const auto f = [&](const auto& x) {
      using S = typename std::decay_t<decltype(x)>::Scalar;
      tp::Vector3<S> ray;
      EXPECT_EQ(this->camera.template cast<S>().unproject_ray(x, &ray), tp::Status::ok);
      return tp::Vector2<S>(this->camera.template cast<S>().project(ray));
    };
    EXPECT_LT(relative_error((dual_derivative<2, 2>(f, px)), Eigen::Matrix2d(Eigen::Matrix2d::Identity())), 1e-10)
        << px;
  }
}

TYPED_TEST(CameraModel, LevelsShareTheirRays) {
  Random random(6);
  for (int level = 0; level < 5; ++level) {
    const double scale = 1 << level;
    const Eigen::Vector2d px = this->camera.project(seen_direction(this->camera, 0.9, random)),
                          coarse = (px.array() + 0.5) / scale - 0.5;
    Eigen::Vector3d fine_ray(0, 0, 0), coarse_ray(0, 0, 0);
    ASSERT_EQ(this->camera.unproject_ray(px, &fine_ray), tp::Status::ok);
    ASSERT_EQ(this->camera.at_level(level).unproject_ray(coarse, &coarse_ray), tp::Status::ok);
    EXPECT_LT((coarse_ray - fine_ray).norm(), 1e-12);
  }
}

TYPED_TEST(CameraModel, IsPinholeWhereItProjectsAsOne) {
  const auto differs = [&](const TypeParam& model) {
    Random random(7);
    double worst = 0;
    for (int i = 0; i < 20; ++i) {
      const Eigen::Vector3d p = model.pinhole().unproject(this->pixel(random));
      worst = std::max(worst, (model.project(p) - model.pinhole().project(p)).norm());
    }
    return worst > 1e-12;
  };
  EXPECT_NE(this->camera.is_pinhole(), differs(this->camera));
  auto p = this->camera.parameters();
  for (int i = 4; i < TypeParam::kParameters; ++i) p[i] = 0;
  const TypeParam plain = TypeParam::from_parameters(p);
  EXPECT_NE(plain.is_pinhole(), differs(plain));
}

TYPED_TEST(CameraModel, InFloat) {
  const auto in_float = this->camera.template cast<float>();
  Random random(9);
  for (int i = 0; i < this->kPoints; ++i) {
    const Eigen::Vector3d unit = this->point(i, random).normalized();
    if (std::abs(unit[2]) < 0.05) continue;  // a pinhole's pixels run away there
    const Eigen::Vector2f px = in_float.project(unit.cast<float>());
    EXPECT_LT((px.cast<double>() - this->camera.project(unit)).norm(), 1e-4 * (1 + px.norm())) << unit;
    Eigen::Vector3f ray = Eigen::Vector3f::Zero();
    ASSERT_EQ(in_float.unproject_ray(px, &ray), tp::Status::ok) << unit;
    EXPECT_LT((ray.cast<double>() - unit).norm(), 2e-5) << unit;
  }
}

template <class S>
class PinholeTest : public testing::Test {};
using Scalars = testing::Types<float, double, Dual<2>>;
TYPED_TEST_SUITE(PinholeTest, Scalars, );

TYPED_TEST(PinholeTest, PixelAndRayInvertEachOther) {
  using S = TypeParam;
  const tp::Pinhole<S> camera = kPinhole.cast<S>();
  Random random(1);
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector2d px(random.uniform(0, 640), random.uniform(0, 480));
    const tp::Vector3<S> m = camera.unproject(px.cast<S>());
    EXPECT_EQ(m[2], S(1));
    EXPECT_LT((values(camera.pixel(m.template head<2>())) - px).norm(), tolerance<S>(1e-4, 1e-12));
    EXPECT_LT((values(camera.project(tp::Vector3<S>(m * S(3)))) - px).norm(), tolerance<S>(2e-4, 1e-12));
  }
}

TYPED_TEST(PinholeTest, LevelsShareTheirRays) {
  using S = TypeParam;
  const tp::Pinhole<S> camera = kPinhole.cast<S>();
  for (int level = 0; level < 5; ++level) {
    const double scale = 1 << level;
    const Eigen::Vector2d px(100.25, 33.5), coarse((px[0] + 0.5) / scale - 0.5, (px[1] + 0.5) / scale - 0.5);
    const auto fine_ray = values(camera.unproject(px.cast<S>()));
    EXPECT_LT((values(camera.at_level(level).unproject(coarse.cast<S>())) - fine_ray).norm(),
              tolerance<S>(1e-6, 1e-14));
  }
}

}  // namespace camera_test
