// A camera of any model maps points, pixels and derivatives without allocating.
#include "allocation/count.hpp"
#include "textplane/core/cameras/any_camera.hpp"

namespace {
using namespace textplane_test;
namespace tp = textplane;

TEST(NoAllocation, CamerasOfAnyModel) {
  const tp::Pinhole<double> pinhole(190, 191, 254, 256);
  const tp::AnyCamera<double> cameras[] = {pinhole,
                                           tp::RadialTangential<double>{pinhole, -0.2, 0.05, 0, 0, 0},
                                           tp::Rational<double>{pinhole, 0.1, 0.05, 0, 0, 0, 0.2, 0, 0},
                                           tp::KannalaBrandt<double>{pinhole, 0.003, 0, 0, 0},
                                           tp::DoubleSphere<double>{pinhole, -0.2, 0.6},
                                           tp::ExtendedUnified<double>{pinhole, 0.6, 1},
                                           tp::Fov<double>{pinhole, 0.9}};
  bool ok = true;
  double sum = 0;
  {
    const NoAllocation guard;
    for (const tp::AnyCamera<double>& camera : cameras) {
      tp::FixedMatrix<double, 2, 3> J_p;
      tp::AnyCamera<double>::ParameterJacobian J;
      tp::Vector3<double> m(0, 0, 0), ray(0, 0, 0);
      const tp::Vector2<double> px = camera.project({0.2, -0.1, 1}, &J_p, &J);
      ok = ok && tp::is_ok(camera.unproject(px, &m)) && tp::is_ok(camera.unproject_ray(px, &ray));
      tp::AnyCamera<double> copy;
      ok = ok && tp::is_ok(tp::AnyCamera<double>::make(camera.name(), camera.parameters(), &copy));
      sum += J(0, 0) + J_p(0, 0) + m[0] + ray[0] + copy.at_level(1).pinhole().fx;
    }
  }
  EXPECT_TRUE(ok);
  EXPECT_GT(sum, 0);
}

}  // namespace
