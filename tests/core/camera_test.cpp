// What core/cameras/camera.hpp says of every model. A new model is a line in example().
#include "textplane/core/cameras/camera.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/calculus.hpp"
#include "textplane/core/cameras/pinhole.hpp"
#include "textplane/core/cameras/radial_tangential.hpp"

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

const tp::Pinhole<double> kPinhole(525.5, 519.25, 319.5, 241.75);

template <class Model>
class CameraModel : public testing::Test {
 protected:
  static void example(tp::Pinhole<double>* camera) { *camera = kPinhole; }
  static void example(tp::RadialTangential<double>* camera) {
    *camera = {kPinhole, -0.28, 0.07, 0.001, -0.0008, -0.005};
  }
  CameraModel() { example(&camera); }

  Model camera;
  // Over the whole of a 640 x 480 image.
  Eigen::Vector2d pixel(Random& random) const { return {random.uniform(0, 639), random.uniform(0, 479)}; }
};
using Models = testing::Types<tp::Pinhole<double>, tp::RadialTangential<double>>;
TYPED_TEST_SUITE(CameraModel, Models, );

TYPED_TEST(CameraModel, ParametersMakeTheSameCamera) {
  const auto p = this->camera.parameters();
  EXPECT_EQ(TypeParam::from_parameters(p).parameters(), p);
  EXPECT_EQ(p.template head<4>(), this->camera.pinhole().parameters());
  EXPECT_EQ(this->camera.template cast<float>().template cast<double>().parameters(),
            p.template cast<float>().template cast<double>());
}

TYPED_TEST(CameraModel, ValidNeedsFiniteParametersAndPositiveFocalLengths) {
  EXPECT_TRUE(this->camera.valid());
  for (int i = 0; i < TypeParam::kParameters; ++i)
    for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity(), 0.0, -1.0}) {
      auto p = this->camera.parameters();
      p[i] = bad;
      EXPECT_EQ(TypeParam::from_parameters(p).valid(), i >= 2 && std::isfinite(bad)) << i << " " << bad;
    }
}

TYPED_TEST(CameraModel, UnprojectInvertsProject) {
  Random random(5);
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector2d px = this->pixel(random);
    Eigen::Vector3d m;
    ASSERT_EQ(this->camera.unproject(px, &m), tp::Status::ok);
    EXPECT_EQ(m[2], 1);
    const Eigen::Vector3d p = random.uniform(0.1, 9) * m;
    EXPECT_TRUE(this->camera.in_domain(p));
    EXPECT_FALSE(this->camera.in_domain(-p));
    EXPECT_LT((this->camera.project(p) - px).norm(), 1e-9);
  }
}

TYPED_TEST(CameraModel, UnprojectRefusesNaN) {
  const Eigen::Vector3d untouched(7, 8, 9);
  Eigen::Vector3d m = untouched;
  EXPECT_EQ(this->camera.unproject({std::nan(""), 0}, &m), tp::Status::non_finite);
  EXPECT_EQ(m, untouched);
}

TYPED_TEST(CameraModel, ProjectJacobian) {
  Random random(2);
  for (int i = 0; i < 20; ++i) {
    Eigen::Vector3d p;
    ASSERT_EQ(this->camera.unproject(this->pixel(random), &p), tp::Status::ok);
    p *= random.uniform(0.5, 5);
    Eigen::Matrix<double, 2, 3> J;
    EXPECT_EQ(this->camera.project(p, &J), this->camera.project(p));
    const auto f = [&](const auto& x) {
      using S = typename std::decay_t<decltype(x)>::Scalar;
      return tp::Vector2<S>(this->camera.template cast<S>().project(x));
    };
    EXPECT_LT(relative_error(J, (central_difference<2, 3>(f, p))), 1e-9);
    EXPECT_LT(relative_error(J, (dual_derivative<2, 3>(f, p))), 1e-14);
  }
}

TYPED_TEST(CameraModel, LevelsShareTheirRays) {
  Random random(6);
  for (int level = 0; level < 5; ++level) {
    const double scale = 1 << level;
    const Eigen::Vector2d px = this->pixel(random), coarse = (px.array() + 0.5) / scale - 0.5;
    Eigen::Vector3d fine_ray, coarse_ray;
    ASSERT_EQ(this->camera.unproject(px, &fine_ray), tp::Status::ok);
    ASSERT_EQ(this->camera.at_level(level).unproject(coarse, &coarse_ray), tp::Status::ok);
    EXPECT_LT((coarse_ray - fine_ray).norm(), 1e-12);
  }
}

TYPED_TEST(CameraModel, IsPinholeWhereItProjectsAsOne) {
  Random random(7);
  double worst = 0;
  for (int i = 0; i < 20; ++i) {
    const Eigen::Vector3d p = this->camera.pinhole().unproject(this->pixel(random));
    worst = std::max(worst, (this->camera.project(p) - this->camera.pinhole().project(p)).norm());
  }
  EXPECT_EQ(this->camera.is_pinhole(), worst < 1e-12);
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
