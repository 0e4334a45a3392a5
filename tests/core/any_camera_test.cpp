// AnyCamera does what the model in it does.
#include "textplane/core/cameras/any_camera.hpp"

#include <gtest/gtest.h>

#include <string>
#include <type_traits>
#include <vector>

#include "core/camera_support.hpp"
#include "support/calculus.hpp"

using textplane_test::Dual;
using textplane_test::relative_error;

template class textplane::AnyCamera<float>;
template class textplane::AnyCamera<double>;
template class textplane::AnyCamera<Dual<2>>;

namespace camera_test {

using Any = tp::AnyCamera<double>;
static_assert(std::is_convertible<tp::Fov<double>, Any>::value && !std::is_convertible<double, Any>::value, "");
static_assert(!std::is_convertible<tp::Fov<float>, Any>::value, "cast<double>() says so");
static_assert(std::is_trivially_copyable<Any>::value && std::is_nothrow_move_assignable<Any>::value, "");

// Vectors of different types compared number by number.
template <class Vector>
std::vector<double> numbers(const Vector& v) {
  std::vector<double> out;
  for (int i = 0; i < v.size(); ++i) out.push_back(static_cast<double>(v[i]));
  return out;
}

template <class Model>
class AnyCameraOf : public testing::Test {};
using Models =
    testing::Types<tp::Pinhole<double>, tp::RadialTangential<double>, tp::Rational<double>, tp::KannalaBrandt<double>,
                   tp::DoubleSphere<double>, tp::ExtendedUnified<double>, tp::Fov<double>>;
TYPED_TEST_SUITE(AnyCameraOf, Models, );

TYPED_TEST(AnyCameraOf, HasTheMembersOfItsModel) {
  const auto model = example<TypeParam>();
  const Any any = model;
  EXPECT_STREQ(any.name(), TypeParam::kName);
  ASSERT_NE(any.get_if<TypeParam>(), nullptr);
  EXPECT_EQ(numbers(any.get_if<TypeParam>()->parameters()), numbers(model.parameters()));
  using Other =
      std::conditional_t<std::is_same<TypeParam, tp::Pinhole<double>>::value, tp::Fov<double>, tp::Pinhole<double>>;
  EXPECT_EQ(any.get_if<Other>(), nullptr);
  const int count = any.visit([](const auto& held) { return int{std::decay_t<decltype(held)>::kParameters}; });
  EXPECT_EQ(any.parameters().size(), count);
  EXPECT_EQ(numbers(any.parameters()), numbers(model.parameters()));
  EXPECT_TRUE(any.valid());
  EXPECT_EQ(any.is_pinhole(), model.is_pinhole());
  EXPECT_EQ(numbers(any.pinhole().parameters()), numbers(model.pinhole().parameters()));
  EXPECT_EQ(numbers(any.at_level(2).parameters()), numbers(model.at_level(2).parameters()));
  EXPECT_EQ(numbers(any.cast<float>().parameters()), numbers(model.template cast<float>().parameters()));
  EXPECT_STREQ(any.cast<float>().name(), TypeParam::kName);
}

TYPED_TEST(AnyCameraOf, MapsAsItsModel) {
  const auto model = example<TypeParam>();
  const Any any = model;
  Random random(1);
  for (int i = 0; i < 20; ++i) {
    const Eigen::Vector3d p = 2 * seen_direction(model, 0.95, random);
    Eigen::Matrix<double, 2, 3> J_p, J_p_model;
    tp::FixedMatrix<double, 2, TypeParam::kParameters> J_model;
    Any::ParameterJacobian J;
    const Eigen::Vector2d px = model.project(p, &J_p_model, &J_model);
    EXPECT_LT((any.project(p, &J_p, &J) - px).norm(), 1e-11);
    EXPECT_LT(relative_error(J_p, J_p_model), 1e-14);
    ASSERT_EQ(J.cols(), J_model.cols());
    EXPECT_LT(relative_error(J.data(), J_model.data(), J_model.size()), 1e-14);
    J_p.setZero();
    EXPECT_LT((any.project(p, &J_p) - px).norm(), 1e-11);
    EXPECT_LT(relative_error(J_p, J_p_model), 1e-14);
    EXPECT_LT((any.project(p) - px).norm(), 1e-11);
    EXPECT_TRUE(any.in_domain(p));
    EXPECT_FALSE(any.in_domain({0, 0, -1}));
    Eigen::Vector3d a(1, 2, 3), b(1, 2, 3);
    EXPECT_EQ(any.unproject(px, &a), model.unproject(px, &b));
    EXPECT_LT((a - b).norm(), 1e-12 * b.norm());
    EXPECT_EQ(any.unproject_ray(px, &a), model.unproject_ray(px, &b));
    EXPECT_LT((a - b).norm(), 1e-12);
    Eigen::Matrix2d D, D_model;
    EXPECT_LT((any.distort({0.3, -0.2}, &D) - model.distort({0.3, -0.2}, &D_model)).norm(), 1e-14);
    EXPECT_LT(relative_error(D, D_model), 1e-14);
  }
}

TYPED_TEST(AnyCameraOf, IsMadeOfNameAndParameters) {
  const auto model = example<TypeParam>();
  const Any::Parameters parameters = Any(model).parameters();
  Any any;
  ASSERT_EQ(Any::make(TypeParam::kName, parameters, &any), tp::Status::ok);
  EXPECT_STREQ(any.name(), TypeParam::kName);
  EXPECT_EQ(numbers(any.parameters()), numbers(parameters));

  const Any before = tp::Pinhole<double>(1, 2, 3, 4);
  any = before;
  const auto expect_refused = [&](const std::string& name, const Any::Parameters& given) {
    EXPECT_EQ(Any::make(name, given, &any), tp::Status::invalid_argument) << name;
    EXPECT_EQ(numbers(any.parameters()), numbers(before.parameters()));
  };
  expect_refused(std::string(TypeParam::kName) + "2", parameters);
  expect_refused("", parameters);
  expect_refused(TypeParam::kName, parameters.head(parameters.size() - 1));
  Any::Parameters wrong = parameters;
  if (wrong.size() < Any::kMaxParameters) {
    wrong.conservativeResize(wrong.size() + 1);
    wrong[wrong.size() - 1] = 0;
    expect_refused(TypeParam::kName, wrong);
    wrong = parameters;
  }
  wrong[0] = 0;
  expect_refused(TypeParam::kName, wrong);
}

TEST(AnyCamera, IsAPinholeAtFirst) {
  const Any any;
  EXPECT_STREQ(any.name(), "pinhole");
  EXPECT_EQ(any.project({1, 2, 4}), Eigen::Vector2d(0.25, 0.5));
}

}  // namespace camera_test
