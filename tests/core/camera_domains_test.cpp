// Where the domains of the lenses end, which parameters they take, and pixels computed elsewhere.
#include <gtest/gtest.h>

#include <cmath>

#include "core/camera_support.hpp"
#include "support/calculus.hpp"

using textplane_test::Dual;

template struct textplane::Rational<float>;
template struct textplane::Rational<Dual<2>>;
template struct textplane::KannalaBrandt<float>;
template struct textplane::KannalaBrandt<Dual<2>>;
template struct textplane::DoubleSphere<float>;
template struct textplane::DoubleSphere<Dual<2>>;
template struct textplane::ExtendedUnified<float>;
template struct textplane::ExtendedUnified<Dual<2>>;
template struct textplane::Fov<float>;
template struct textplane::Fov<Dual<2>>;

namespace camera_test {

const double kNowhere = 1e9;

// The domain ends at this angle, and the image of it at this distance from the centre, or nowhere.
template <class Model>
void expect_end(const Model& camera, double angle, double radius) {
  for (const double azimuth : {0.0, 1.0, 2.5, -2.0}) {
    EXPECT_TRUE(camera.in_domain(3 * direction(angle - 1e-9, azimuth))) << azimuth;
    const double beyond = std::min(angle + 1e-9, M_PI);
    EXPECT_FALSE(camera.in_domain(beyond < M_PI ? 3 * direction(beyond, azimuth) : Eigen::Vector3d(0, 0, -3)));
    const auto pixel = [&](double r) { return camera.pinhole().pixel({r * std::cos(azimuth), r * std::sin(azimuth)}); };
    Eigen::Vector3d ray(7, 8, 9);
    const double far = radius * (1 - 1e-12);
    ASSERT_EQ(camera.unproject_ray(pixel(far), &ray), tp::Status::ok);
    EXPECT_LT((ray - direction(angle, azimuth)).norm(), 1e-5);
    if (radius == kNowhere) continue;
    ray = {7, 8, 9};
    EXPECT_EQ(camera.unproject_ray(pixel(radius * (1 + 1e-9)), &ray), tp::Status::degenerate);
    EXPECT_EQ(ray, Eigen::Vector3d(7, 8, 9));
  }
}

TEST(CameraDomains, KannalaBrandtEndsWhereThePolynomialStopsRising) {
  // theta (1 - theta^2 / 10) has its maximum at theta^2 = 10/3.
  const double end = std::sqrt(10. / 3);
  expect_end(tp::KannalaBrandt<double>{kPinhole, -0.1, 0, 0, 0}, end, end * 2 / 3);
  // Slope (1 - s) (1 - s/2), s = theta^2: it rises again beyond s = 2, where other points have the same pixels.
  const tp::KannalaBrandt<double> wave{kPinhole, -0.5, 0.1, 0, 0};
  expect_end(wave, 1, 1 - 0.5 + 0.1);
  for (const double angle : {1.1, 1.4, 1.5, 2.0, 3.0}) EXPECT_FALSE(wave.in_domain(direction(angle, 1)));
  // Slope (1 - s) (1 - s/1.2): the fall between is narrow.
  const tp::KannalaBrandt<double> ripple{kPinhole, (-1 - 1 / 1.2) / 3, 1 / 1.2 / 5, 0, 0};
  for (const double s : {1.05, 1.15, 1.3, 2.0}) EXPECT_FALSE(ripple.in_domain(direction(std::sqrt(s), 1))) << s;
  // Slope 1 - s^2, 1 - s^3 and 1 - s^4.
  expect_end(tp::KannalaBrandt<double>{kPinhole, 0, -1. / 5, 0, 0}, 1, 4. / 5);
  expect_end(tp::KannalaBrandt<double>{kPinhole, 0, 0, -1. / 7, 0}, 1, 6. / 7);
  expect_end(tp::KannalaBrandt<double>{kPinhole, 0, 0, 0, -1. / 9}, 1, 8. / 9);
  // Slope (1 - 9 s / 10)^2 + 1e-3: it rises all the way, though barely.
  expect_end(tp::KannalaBrandt<double>{kPinhole, (-1.8 / 3) / 1.001, 0.81 / 5 / 1.001, 0, 0}, M_PI,
             M_PI * (1 - 0.6 / 1.001 * M_PI * M_PI + 0.162 / 1.001 * std::pow(M_PI, 4)));
  expect_end(tp::KannalaBrandt<double>{kPinhole, 0, 0, 0, 0}, M_PI, M_PI);
  EXPECT_GT(border(example<tp::KannalaBrandt<double>>(), 0), 1.75) << "TUM-VI's lens sees 195 degrees";
}

// Spheres that far apart have no rays: what the formula says of them is not of unit length.
TEST(CameraDomains, SpheresTooFarApartSeeNothing) {
  const tp::DoubleSphere<double> camera{{60, 1e30, 1e30, 1e30}, 1e30, 0.7};
  ASSERT_FALSE(camera.valid());
  tp::Vector3<double> ray(7, 7, 7);
  EXPECT_EQ(camera.unproject_ray({1e30, 1e30}, &ray), tp::Status::degenerate);
  EXPECT_EQ(ray, tp::Vector3<double>(7, 7, 7));
}

// cos of the largest angle on the second sphere is -w, and the ray through it starts at -xi.
TEST(CameraDomains, DoubleSphereEndsWhereTheImageDoes) {
  const double cases[][2] = {{-0.172, 0.593}, {0.5, 0.75}, {0.9, 0.3}, {-0.5, 0.9}, {-0.6, 0.2}, {0, 0}, {0.3, 1}};
  for (const auto& [xi, alpha] : cases) {
    const tp::DoubleSphere<double> camera{kPinhole, xi, alpha};
    const double w = alpha > 0.5 ? (1 - alpha) / alpha : alpha / (1 - alpha), sine2 = 1 - w * w;
    const double cosine = -xi * sine2 - w * std::sqrt(1 - xi * xi * sine2);
    SCOPED_TRACE(testing::Message() << xi << " " << alpha);
    expect_end(camera, std::acos(cosine), alpha > 0.5 ? 1 / std::sqrt(2 * alpha - 1) : kNowhere);
  }
  const tp::DoubleSphere<double> half{kPinhole, 0.4, 0.5};
  EXPECT_TRUE(half.in_domain(direction(M_PI - 1e-6, 1)));
}

TEST(CameraDomains, ExtendedUnifiedEndsWhereTheImageDoes) {
  const double cases[][2] = {{0.626, 1.04}, {0.9, 0.7}, {0.3, 1.5}, {0, 1}, {1, 2}};
  for (const auto& [alpha, beta] : cases) {
    const tp::ExtendedUnified<double> camera{kPinhole, alpha, beta};
    const double w = alpha > 0.5 ? (1 - alpha) / alpha : alpha / (1 - alpha);
    SCOPED_TRACE(testing::Message() << alpha << " " << beta);
    expect_end(camera, std::atan2(std::sqrt((1 - w * w) / beta), -w),
               alpha > 0.5 ? 1 / std::sqrt(beta * (2 * alpha - 1)) : kNowhere);
  }
}

TEST(CameraDomains, FovSeesAllButTheAxisBehind) {
  expect_end(tp::Fov<double>{kPinhole, 0.93}, M_PI, M_PI / 0.93);
  EXPECT_TRUE((tp::Fov<double>{kPinhole, 0.93}).in_domain({1e-100, 0, -1}));
  expect_end(tp::Fov<double>{kPinhole, 0}, M_PI / 2, kNowhere);
}

TEST(CameraDomains, RationalEndsAtThePoleAndAtTheFold) {
  const tp::Rational<double> pole{kPinhole, 0, 0, 0, 0, 0, -1, 0, 0};  // r / (1 - r^2)
  EXPECT_TRUE(pole.in_domain({0, 0.999999, 1}));
  for (const double r : {1.000001, 3.0}) EXPECT_FALSE(pole.in_domain({0, r, 1})) << r;
  Eigen::Vector2d m(7, 8);
  ASSERT_EQ(pole.undistort({0, -1000}, &m), tp::Status::ok);
  EXPECT_NEAR(m[1], 5e-4 - std::sqrt(1 + 25e-8), 1e-12);
  // r (1 - r^2/2) / (1 - r^2) rises again beyond the zero of either.
  EXPECT_FALSE((tp::Rational<double>{kPinhole, -0.5, 0, 0, 0, 0, -1, 0, 0}).in_domain({3, 0, 1}));
  // r / (1 + 3/2 r^2 - r^4/6) falls from r^2 = 1 to 2, and then takes the same values again.
  const tp::Rational<double> wave{kPinhole, 0, 0, 0, 0, 0, 1.5, -1. / 6, 0};
  EXPECT_TRUE(wave.in_domain({0, 0.999, 1}));
  for (const double s : {1.002, 1.5, 2.1, 2.56, 9.0}) EXPECT_FALSE(wave.in_domain({0, std::sqrt(s), 1})) << s;
  // r (1 + a r^2) / (1 + r^2)^3: its slope is zero where 1 + (3a - 5) s - 3 a s^2 = 0; for a = 1/3 at s = sqrt 5 - 2.
  const tp::Rational<double> fold{kPinhole, 1. / 3, 0, 0, 0, 0, 3, 3, 1};
  const double s = -2 + std::sqrt(5.), r = std::sqrt(s);
  EXPECT_NEAR(1 - 4 * s - s * s, 0, 1e-15);
  const auto radius = [](double x) { return x * (1 + x * x / 3) / std::pow(1 + x * x, 3); };
  EXPECT_TRUE(fold.in_domain({0.999 * r, 0, 1}));
  EXPECT_FALSE(fold.in_domain({1.001 * r, 0, 1}));
  EXPECT_FALSE(fold.in_domain({9, 0, 1}));
  m = {7, 8};
  EXPECT_EQ(fold.undistort({1.001 * radius(r), 0}, &m), tp::Status::degenerate);
  EXPECT_EQ(m, Eigen::Vector2d(7, 8));
  ASSERT_EQ(fold.undistort({0, radius(0.99 * r)}, &m), tp::Status::ok);
  EXPECT_LT((m - Eigen::Vector2d(0, 0.99 * r)).norm(), 1e-12);
}

template <class Model>
void expect_forward_limit(const Model& camera) {
  for (const double z : {-1e-3, -5e-7, 0.0, 5e-7, 2e-6, 1e-3}) {
    Eigen::Vector3d m(7, 8, 9);
    const Eigen::Vector2d px = camera.project({1, 0, z});
    EXPECT_EQ(camera.unproject(px, &m), z > 1e-6 ? tp::Status::ok : tp::Status::degenerate) << Model::kName << z;
    EXPECT_EQ(m[2], z > 1e-6 ? 1 : 9);
  }
}

TEST(CameraDomains, UnprojectNeedsARayThatPointsForward) {
  expect_forward_limit(example<tp::KannalaBrandt<double>>());
  expect_forward_limit(example<tp::DoubleSphere<double>>());
  expect_forward_limit(example<tp::ExtendedUnified<double>>());
  expect_forward_limit(example<tp::Fov<double>>());
}

template <class Model>
void expect_valid(const Model& camera, int parameter, double value, bool valid) {
  auto p = camera.parameters();
  p[parameter] = value;
  EXPECT_EQ(Model::from_parameters(p).valid(), valid) << Model::kName << ", parameter " << parameter << ": " << value;
}

TEST(CameraRanges, ModelsRefuseWhatIsOutOfTheirs) {
  const auto sphere = example<tp::DoubleSphere<double>>();
  const auto unified = example<tp::ExtendedUnified<double>>();
  const auto fov = example<tp::Fov<double>>();
  for (const double good : {-0.999, 0.0, 0.999}) expect_valid(sphere, 4, good, true);
  for (const double bad : {-1.0, 1.0, 2.0}) expect_valid(sphere, 4, bad, false);
  for (const double good : {0.0, 0.5, 1.0}) {
    expect_valid(sphere, 5, good, true);
    expect_valid(unified, 4, good, true);
  }
  for (const double bad : {-1e-9, 1 + 1e-9}) {
    expect_valid(sphere, 5, bad, false);
    expect_valid(unified, 4, bad, false);
  }
  expect_valid(unified, 5, 1e-3, true);
  for (const double bad : {0.0, -1.0}) expect_valid(unified, 5, bad, false);
  for (const double good : {0.0, 1e-6, 3.14}) expect_valid(fov, 4, good, true);
  for (const double bad : {-1e-9, 3.15, 10.0}) expect_valid(fov, 4, bad, false);
  for (const double good : {-1.0, 0.0}) {
    for (int i = 4; i < 8; ++i) expect_valid(example<tp::KannalaBrandt<double>>(), i, good, true);
    for (int i = 4; i < 12; ++i) expect_valid(example<tp::Rational<double>>(), i, good, true);
    for (int i = 4; i < 9; ++i) expect_valid(example<tp::RadialTangential<double>>(), i, good, true);
  }
}

struct Projection {
  Eigen::Vector3d p;
  Eigen::Vector2d px;
};
template <class Model>
void expect_pixels(const std::initializer_list<Projection>& projections) {
  const Model camera = example<Model>();
  for (const Projection& at : projections) {
    EXPECT_LT((camera.project(at.p) - at.px).norm(), 1e-12 * at.px.norm()) << Model::kName << " " << at.p.transpose();
    Eigen::Vector3d ray(0, 0, 0);
    ASSERT_EQ(camera.unproject_ray(at.px, &ray), tp::Status::ok);
    EXPECT_LT((ray - at.p.normalized()).norm(), 1e-12) << Model::kName << " " << at.p.transpose();
  }
}

// Computed once in decimal arithmetic of 60 digits, straight from the papers' formulas, with the parameters of
// core/camera_support.hpp as decimal numbers.
TEST(CameraReference, PixelsInHighPrecision) {
  const Eigen::Vector3d a(0.3, -0.2, 1), b(-1.5, 0.7, 0.4), c(1.1, 2.3, -0.6), d(0.001, -0.002, 3);
  expect_pixels<tp::DoubleSphere<double>>({{a, {309.977816166297507, 219.804651431845586}},
                                           {b, {23.7442315319125451, 364.304547484337775}},
                                           {c, {399.093034481686771, 557.804068951395788}},
                                           {d, {254.963727846658735, 256.372624821965737}}});
  expect_pixels<tp::ExtendedUnified<double>>({{a, {309.973290007137914, 219.803686058387086}},
                                              {b, {22.9069279376265141, 364.706780864257230}},
                                              {c, {400.275822594399522, 560.308566984062175}},
                                              {d, {254.963699988480213, 256.372666689694185}}});
  expect_pixels<tp::KannalaBrandt<double>>({{a, {309.943286746347728, 220.223769003723763}},
                                            {b, {24.3685656479946069, 364.490452383534118}},
                                            {c, {399.120787440523640, 558.374753262974500}},
                                            {d, {254.995659321667646, 256.769684689997430}}});
  expect_pixels<tp::Fov<double>>({{a, {428.353357915431026, 169.025811758829961}},
                                  {b, {-136.250917583926855, 454.888862312787476}},
                                  {c, {612.385368608147319, 855.457086407228675}},
                                  {d, {319.626052247177061, 241.497356052376933}}});
  expect_pixels<tp::Rational<double>>(
      {{a, {479.049041721229448, 136.669280355140005}}, {d, {319.675166438949988, 241.403833754502802}}});
}

}  // namespace camera_test
