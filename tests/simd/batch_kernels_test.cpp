// The batch kernel on every target: any number of objects of mixed sizes against the double reference, one by one.
#include <memory>

#include "simd/policy_support.hpp"
#include "textplane/photometry/text_batch.hpp"

namespace batch_kernels_test {
namespace tp = textplane;
using textplane_test::PolicyScene;
using textplane_test::unknowns;

// Of simd/residual.hpp, for gradients of up to 90 grey levels a px.
constexpr double kTolerance = 3e-5;

// Objects in one image: scenes of one seed share it. Pixels 1 to 65, a third of the patches masked.
struct Objects {
  std::vector<std::unique_ptr<PolicyScene>> scenes;
  std::vector<tp::TextBatchItem> items;
  std::vector<tp::SE3d> poses;

  explicit Objects(int count) {
    for (int i = 0; i < count; ++i) {
      scenes.push_back(std::make_unique<PolicyScene>(4, 1 + (i * 17 + count) % 65));
      PolicyScene& s = *scenes.back();
      items.push_back({s.policy_input(i % 3 == 0).patch, s.host_camera, s.theta});
      poses.push_back(s.T_t_h);
    }
  }
  // All of n pixels, none masked, each from a pose of its own.
  Objects(int count, int n) {
    for (int i = 0; i < count; ++i) {
      scenes.push_back(std::make_unique<PolicyScene>(4, n));
      PolicyScene& s = *scenes.back();
      items.push_back({s.policy_input(false).patch, s.host_camera, s.theta});
      const tp::Vector6<double> xi = 1e-3 * i * (tp::Vector6<double>() << 1, -1, 2, 0.5, 1, -1).finished();
      poses.push_back(tp::se3_exp<double>(xi) * s.T_t_h);
    }
  }
  tp::ImageView8 image() const { return scenes[0]->view(); }
  const tp::Pinhole<double>& camera() const { return scenes[0]->target_camera; }
};

template <int P>
tp::NormalEquations<P> reference_of(PolicyScene& s, const tp::TextBatchItem& item, const tp::SE3d& pose,
                                    const tp::PhotometricOptions& o) {
  tp::PhotometricInput in = s.input();
  in.patch = item.patch;
  return tp::reference::linearise<unknowns<P>()>(
      tp::ResidualRequest{in, s.theta, pose, o}.by(tp::LinearisePolicy::forward), s.workspace);
}

template <int P>
void compare(Objects& objects, const tp::PhotometricOptions& o) {
  const int count = static_cast<int>(objects.items.size());
  const tp::TextBatch batch(objects.items.data(), count);
  tp::TextBatchResult result(batch);
  ASSERT_EQ(
      tp::linearise_batch<unknowns<P>()>(batch, objects.image(), objects.camera(), objects.poses.data(), o, result),
      tp::Status::ok);
  for (int i = 0; i < count; ++i) {
    SCOPED_TRACE(i);
    const auto k = static_cast<std::size_t>(i);
    tp::PhotometricOptions plain = o;
    plain.normalisation = tp::Normalisation::frozen;
    const auto scale = reference_of<P>(*objects.scenes[k], objects.items[k], objects.poses[k], plain);
    const auto reference = reference_of<P>(*objects.scenes[k], objects.items[k], objects.poses[k], o);
    textplane_test::expect_close<P>(result.normal_equations<unknowns<P>()>(i), reference, kTolerance, scale);
  }
}

TEST(BatchKernels, EveryTargetAndCount) {
  for (const tp::simd::Target target : textplane_test::testable_targets()) {
    const textplane_test::TargetScope scope(target);
    SCOPED_TRACE(tp::simd::to_string(target));
    for (int count = 1; count <= 33; ++count) {
      SCOPED_TRACE(count);
      Objects objects(count);
      const auto all = textplane_test::all_options(2);
      compare<9>(objects, all[static_cast<std::size_t>(count) % 4]);
      compare<6>(objects, all[static_cast<std::size_t>(count + 1) % 4]);
    }
  }
}

TEST(BatchKernels, CostsAloneAreThoseOfTheEquations) {
  for (const tp::simd::Target target : textplane_test::testable_targets()) {
    const textplane_test::TargetScope scope(target);
    Objects objects(21);
    const tp::TextBatch batch(objects.items.data(), 21);
    tp::TextBatchResult costs(batch), equations(batch);
    tp::PhotometricOptions o;
    o.min_visible = 4;
    tp::evaluate_batch(batch, objects.image(), objects.camera(), objects.poses.data(), o, costs);
    tp::linearise_batch<tp::Parameters::pose_plane>(batch, objects.image(), objects.camera(), objects.poses.data(), o,
                                                    equations);
    for (int i = 0; i < 21; ++i) {
      EXPECT_EQ(costs.status(i), equations.status(i));
      EXPECT_EQ(costs.cost(i), equations.cost(i));
      EXPECT_EQ(costs.zncc(i), equations.zncc(i));
      EXPECT_EQ(costs.visible(i), equations.visible(i));
    }
  }
}

// No sum crosses lanes: an object's result is the same bits in any company.
TEST(BatchKernels, NeighboursDoNotMatter) {
  for (const tp::simd::Target target : textplane_test::testable_targets()) {
    const textplane_test::TargetScope scope(target);
    Objects objects(19);
    const tp::TextBatch batch(objects.items.data(), 19);
    tp::TextBatchResult together(batch);
    tp::PhotometricOptions o;
    o.min_visible = 4;
    tp::linearise_batch<tp::Parameters::pose>(batch, objects.image(), objects.camera(), objects.poses.data(), o,
                                              together);
    for (int i = 0; i < 19; ++i) {
      const tp::TextBatch single(&objects.items[static_cast<std::size_t>(i)], 1);
      tp::TextBatchResult alone(single);
      tp::linearise_batch<tp::Parameters::pose>(single, objects.image(), objects.camera(),
                                                &objects.poses[static_cast<std::size_t>(i)], o, alone);
      EXPECT_EQ(alone.normal_equations<tp::Parameters::pose>(0).H,
                together.normal_equations<tp::Parameters::pose>(i).H);
      EXPECT_EQ(alone.normal_equations<tp::Parameters::pose>(0).b,
                together.normal_equations<tp::Parameters::pose>(i).b);
    }
  }
}

// A vector whose objects are of one size and wholly visible is summed without masks: to the same bits as beside one
// that is not.
TEST(BatchKernels, WhollyVisibleVectors) {
  for (const tp::simd::Target target : textplane_test::testable_targets()) {
    const textplane_test::TargetScope scope(target);
    SCOPED_TRACE(tp::simd::to_string(target));
    for (const int n : {5, 15, 40}) {
      SCOPED_TRACE(n);
      Objects objects(16, n);
      tp::PhotometricOptions o;
      o.min_visible = 4;
      compare<9>(objects, o);
      compare<6>(objects, o);
      const tp::TextBatch batch(objects.items.data(), 16);
      tp::TextBatchResult whole(batch), beside(batch);
      tp::linearise_batch<tp::Parameters::pose_plane>(batch, objects.image(), objects.camera(), objects.poses.data(), o,
                                                      whole);
      for (const std::size_t away : {std::size_t{3}, std::size_t{12}}) objects.poses[away].t[0] += 100;
      tp::linearise_batch<tp::Parameters::pose_plane>(batch, objects.image(), objects.camera(), objects.poses.data(), o,
                                                      beside);
      for (int i = 0; i < 16; ++i) {
        ASSERT_EQ(whole.status(i), tp::Status::ok);
        EXPECT_EQ(whole.visible(i), n);
        EXPECT_EQ(beside.status(i), i == 3 || i == 12 ? tp::Status::out_of_view : tp::Status::ok);
        if (i == 3 || i == 12) continue;
        EXPECT_EQ(beside.normal_equations<tp::Parameters::pose_plane>(i).H,
                  whole.normal_equations<tp::Parameters::pose_plane>(i).H);
        EXPECT_EQ(beside.normal_equations<tp::Parameters::pose_plane>(i).b,
                  whole.normal_equations<tp::Parameters::pose_plane>(i).b);
        EXPECT_EQ(beside.cost(i), whole.cost(i));
      }
    }
  }
}

TEST(BatchKernels, StatusesPartlyVisibleAndRejected) {
  for (const tp::simd::Target target : textplane_test::testable_targets()) {
    const textplane_test::TargetScope scope(target);
    Objects objects(16);
    const std::vector<float> flat(65, 90.0F);
    for (std::size_t i = 0; i < 16; ++i) {
      PolicyScene& s = *objects.scenes[i];
      tp::SE3d& T = objects.poses[i];
      if (i == 1) T.t[0] += 100;
      if (i == 2) T.t[2] -= 100;
      if (i == 3) T.t[1] = std::nan("");
      if (i == 4) objects.items[i].patch.intensity = flat.data();
      if (i == 5) objects.items[i].theta[2] = std::nan("");
      if (i == 6) s.theta = objects.items[i].theta = -s.theta;
      if (i == 7) objects.items[i].patch.n = 0;
      if (i == 8) s.theta[0] = objects.items[i].theta[0] = 1e200;  // finite, but not in float: said to be non_finite
      if (i >= 10) T.t[0] += 0.08 * static_cast<double>(i - 9);    // leaves the image pixel by pixel
    }
    const tp::TextBatch batch(objects.items.data(), 16);
    tp::TextBatchResult result(batch);
    tp::PhotometricOptions o;
    o.min_visible = 3;
    tp::linearise_batch<tp::Parameters::pose_plane>(batch, objects.image(), objects.camera(), objects.poses.data(), o,
                                                    result);
    for (int i = 0; i < 16; ++i) {
      SCOPED_TRACE(i);
      const auto k = static_cast<std::size_t>(i);
      objects.scenes[k]->theta = objects.items[k].theta;
      auto reference = reference_of<9>(*objects.scenes[k], objects.items[k], objects.poses[k], o);
      if (i == 8) reference.status = tp::Status::non_finite;
      EXPECT_EQ(result.status(i), reference.status)
          << tp::to_string(result.status(i)) << tp::to_string(reference.status);
      if (!tp::is_ok(reference.status)) {
        EXPECT_TRUE(textplane_test::all_zero(result.normal_equations<tp::Parameters::pose_plane>(i)));
      } else {
        EXPECT_EQ(result.visible(i), reference.visible);
      }
    }
    EXPECT_EQ(result.status(1), tp::Status::out_of_view);
    EXPECT_EQ(result.status(2), tp::Status::behind_camera);
    EXPECT_EQ(result.status(3), tp::Status::non_finite);
  }
}

// A camera that is valid(), but whose H is not of float: said to be non_finite, not ok with an infinity. Its neighbours
// are not touched.
template <int P>
void compare_extreme_cameras() {
  Objects objects(5);
  tp::PhotometricOptions o;
  o.min_visible = 4;
  const tp::TextBatch batch(objects.items.data(), 5);
  tp::TextBatchResult result(batch);
  for (int power = 0; power >= -45; --power)
    for (const bool both : {false, true}) {
      SCOPED_TRACE(power);
      tp::Pinhole<double> camera = objects.camera();
      camera.fx *= std::pow(10, power);
      if (both) camera.fy *= std::pow(10, power);
      ASSERT_EQ(tp::linearise_batch<unknowns<P>()>(batch, objects.image(), camera, objects.poses.data(), o, result),
                tp::Status::ok);
      for (int i = 0; i < 5; ++i) {
        const auto equations = result.normal_equations<unknowns<P>()>(i);
        EXPECT_TRUE(tp::all_finite(equations.H) && tp::all_finite(equations.b) && tp::is_finite(equations.cost)) << i;
        if (tp::is_ok(equations.status)) continue;
        EXPECT_TRUE(textplane_test::all_zero(equations)) << i;
        EXPECT_EQ(result.cost(i), 0) << i;
      }
    }
}

TEST(BatchKernels, NoCameraGivesAnInfinity) {
  for (const tp::simd::Target target : textplane_test::testable_targets()) {
    const textplane_test::TargetScope scope(target);
    SCOPED_TRACE(tp::simd::to_string(target));
    compare_extreme_cameras<6>();
    compare_extreme_cameras<9>();
  }
}

TEST(BatchKernels, BadArguments) {
  Objects objects(3);
  objects.items[1].patch.x = nullptr;
  const tp::TextBatch batch(objects.items.data(), 3);
  tp::TextBatchResult result(batch), small;
  tp::PhotometricOptions o;
  o.min_visible = 1;
  const auto run = [&](const tp::ImageView8& image, const tp::SE3d* poses, tp::TextBatchResult& r) {
    return tp::linearise_batch<tp::Parameters::pose>(batch, image, objects.camera(), poses, o, r);
  };
  EXPECT_EQ(run(objects.image(), objects.poses.data(), small), tp::Status::invalid_argument);
  EXPECT_EQ(run(objects.image(), nullptr, result), tp::Status::invalid_argument);
  EXPECT_EQ(run(tp::ImageView8(), objects.poses.data(), result), tp::Status::invalid_argument);
  EXPECT_EQ(result.status(0), tp::Status::invalid_argument);
  EXPECT_EQ(run(objects.image(), objects.poses.data(), result), tp::Status::ok);
  EXPECT_EQ(result.status(1), tp::Status::invalid_argument);
  o.min_contrast = 1e31;
  EXPECT_EQ(run(objects.image(), objects.poses.data(), result), tp::Status::invalid_argument);
  o.min_contrast = 1;
  o.robust.delta = -1;
  EXPECT_EQ(run(objects.image(), objects.poses.data(), result), tp::Status::invalid_argument);
  tp::TextBatch empty;
  EXPECT_EQ(empty.build(nullptr, 2), tp::Status::invalid_argument);
  EXPECT_EQ(empty.build(nullptr, 0), tp::Status::ok);
  EXPECT_EQ(empty.size(), 0);
  for (tp::TextBatchItem& item : objects.items) item.patch.n = 0;  // no pixels at all: no memory either
  EXPECT_EQ(empty.build(objects.items.data(), 3), tp::Status::ok);
  EXPECT_EQ(empty.max_pixels(), 0);
}

}  // namespace batch_kernels_test
