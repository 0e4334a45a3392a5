// Ours: normal equations of pose, pose and plane, both poses and plane; template Jacobian and ESM; cost alone; a batch
// of small objects. Errors: the largest difference from the double reference, over sqrt(H_ii H_jj) for H, over
// sqrt(H_ii) for b.
#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "compare.hpp"
#include "registry.hpp"
#include "scene.hpp"
#include "textplane/photometry/prepared_target.hpp"
#include "textplane/photometry/residual_policy.hpp"
#include "textplane/photometry/text_batch.hpp"

namespace textplane_bench {

namespace {

// Scenes to cycle through, each with its start, and memory for the kernels.
struct Cycle {
  std::vector<Scene> scenes;
  std::vector<tp::PhotometricInput> inputs;
  std::vector<std::vector<float>> gradients;
  std::vector<tp::TemplatePatch> prepared;
  std::vector<tp::PreparedTarget> pairs;
  tp::PhotometricWorkspace workspace;

  Cycle(int n, int count, bool with_pairs) : Cycle(scattered(n, count), with_pairs) {}

  Cycle(std::vector<Scene> all, bool with_pairs) : scenes(std::move(all)), workspace(scenes.front().n()) {
    gradients.resize(scenes.size());
    prepared.resize(scenes.size());
    pairs.resize(scenes.size());
    for (std::size_t i = 0; i < scenes.size(); ++i) {
      Scene& s = scenes[i];
      tp::PhotometricInput in = s.input();
      in.patch.bounds = tp::simd::point_bounds(s.x.data(), s.y.data(), s.n());
      std::vector<float>& g = gradients[i];
      for (const bool vertical : {false, true})
        for (int k = 0; k < s.n(); ++k) {
          const int x = static_cast<int>(s.x[static_cast<std::size_t>(k)]),
                    y = static_cast<int>(s.y[static_cast<std::size_t>(k)]);
          const int dx = vertical ? 0 : 1, dy = vertical ? 1 : 0;
          g.push_back(0.5F * static_cast<float>(s.host(x + dx, y + dy) - s.host(x - dx, y - dy)));
        }
      in.patch.gx = g.data();
      in.patch.gy = g.data() + s.n();
      prepared[i].prepare(in.patch);
      if (with_pairs) {
        pairs[i].prepare(s.target_view());
        in.pairs = pairs[i].view();
      }
      inputs.push_back(in);
    }
  }

  static std::vector<Scene> scattered(int n, int count) {
    std::vector<Scene> all;
    for (int i = 0; i < count; ++i) all.push_back(make_scene(n, static_cast<unsigned>(i + 1)));
    return all;
  }
  static std::vector<Scene> behind(const std::shared_ptr<const tp::LensMap>& lens, int n, int count) {
    std::vector<Scene> all;
    for (int i = 0; i < count; ++i) all.push_back(make_scene(n, static_cast<unsigned>(i + 1), 1.0, {}, 1.0, lens));
    return all;
  }
  static std::vector<Scene> dense(int columns, int rows, int count) {
    std::vector<Scene> all;
    for (int i = 0; i < count; ++i) all.push_back(make_dense_scene(columns, rows, static_cast<unsigned>(i + 1)));
    return all;
  }
};

template <int P>
Errors errors_and_cost(const tp::NormalEquations<P>& ours, const tp::NormalEquations<P>& reference) {
  Errors e = errors(ours, reference);
  e["error_cost"] = std::abs(ours.cost - reference.cost);
  return e;
}

// `linearise(cycle, i)` and `reference(cycle, i)` give normal equations for scene i.
template <class Linearise, class Reference>
std::function<Work()> equations(const std::function<std::shared_ptr<Cycle>()>& make, const Linearise& linearise,
                                const Reference& reference) {
  return [=] {
    const auto cycle = make();
    Work work;
    work.items = cycle->scenes.front().n();
    for (std::size_t i = 0; i < cycle->scenes.size(); ++i)
      largest(errors_and_cost(linearise(*cycle, i), reference(*cycle, i)), &work.errors);
    work.call = [=](std::size_t i) { keep(linearise(*cycle, i % cycle->scenes.size())); };
    return work;
  };
}

std::function<std::shared_ptr<Cycle>()> cycle_of(int n, int count = 4, bool pairs = false) {
  return [=] { return std::make_shared<Cycle>(n, count, pairs); };
}
std::function<std::shared_ptr<Cycle>()> dense_cycle_of(int columns, int rows) {
  return [=] { return std::make_shared<Cycle>(Cycle::dense(columns, rows, 4), false); };
}

tp::ResidualRequest<std::uint8_t> request(const Cycle& c, std::size_t i, bool huber = true) {
  const Scene& s = c.scenes[i];
  return {c.inputs[i], s.theta_start, s.T_start, options(huber)};
}

template <tp::Parameters U>
void add_policy(const std::string& name, tp::LinearisePolicy policy, bool huber, const std::string& size,
                const std::function<std::shared_ptr<Cycle>()>& make) {
  const auto ours = [=](Cycle& c, std::size_t i) {
    return tp::linearise<U>(request(c, i, huber).by(policy, &c.prepared[i]), c.workspace);
  };
  const auto reference = [=](Cycle& c, std::size_t i) {
    return tp::reference::linearise<U>(request(c, i, huber).by(policy, &c.prepared[i]), c.workspace);
  };
  add_targets(name, size, equations(make, ours, reference));
}

template <tp::Parameters U>
void add_forward(const std::string& name, const std::string& size,
                 const std::function<std::shared_ptr<Cycle>()>& make) {
  const auto request_of = [](Cycle& c, std::size_t i) {
    const Scene& s = c.scenes[i];
    if constexpr (U == tp::Parameters::host_target_plane)
      return tp::world_request(c.inputs[i], s.theta_start, tp::SE3d(), s.T_start.inverse(), tp::PerturbationSide::right,
                               options(true));
    else
      return request(c, i);
  };
  const auto ours = [=](Cycle& c, std::size_t i) { return tp::linearise<U>(request_of(c, i), c.workspace); };
  const auto reference = [=](Cycle& c, std::size_t i) {
    return tp::reference::linearise<U>(request_of(c, i), c.workspace);
  };
  add_targets(name, size, equations(make, ours, reference));
}

void add_cost(const std::string& name, int n, const std::function<std::shared_ptr<Cycle>()>& make) {
  const auto cost = [=] {
    const auto cycle = make();
    Work work;
    work.items = n;
    const auto evaluate = [cycle](std::size_t i) { return tp::evaluate(request(*cycle, i), cycle->workspace); };
    double worst = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      const auto want = tp::reference::evaluate(request(*cycle, i), cycle->workspace);
      worst = std::max(worst, std::abs(evaluate(i).cost - want.cost));
    }
    work.errors["error_cost"] = worst;
    work.call = [=](std::size_t i) { keep(evaluate(i % 4)); };
    return work;
  };
  add_targets(name, std::to_string(n), cost);
}

// The forms that tracking uses, behind a lens.
template <class Model>
void add_lens(const Model& model) {
  constexpr int kPixels = 4000;
  const auto lens = std::make_shared<const tp::LensMap>(model);
  const auto cycle = [=] { return std::make_shared<Cycle>(Cycle::behind(lens, kPixels, 4), false); };
  const std::string size = std::to_string(kPixels), of_lens = std::string("_") + Model::kName;
  add_forward<tp::Parameters::pose_plane>("pose_plane" + of_lens, size, cycle);
  add_forward<tp::Parameters::pose>("pose" + of_lens, size, cycle);
  add_forward<tp::Parameters::plane>("plane" + of_lens, size, cycle);
  add_policy<tp::Parameters::pose_plane>("template_huber" + of_lens, tp::LinearisePolicy::template_jacobian, true, size,
                                         cycle);
  add_policy<tp::Parameters::pose_plane>("esm" + of_lens, tp::LinearisePolicy::esm, true, size, cycle);
  add_cost("cost" + of_lens, kPixels, cycle);
}

// Sixteen objects of n pixels: one object a lane.
template <tp::Parameters kUnknowns>
Work batch_work(int n) {
  constexpr int kObjects = 16;
  const auto cycle = std::make_shared<Cycle>(n, kObjects, false);
  std::vector<tp::TextBatchItem> items(kObjects);
  const auto poses = std::make_shared<std::vector<tp::SE3d>>();
  const Scene& first = cycle->scenes[0];  // all in its image
  for (std::size_t i = 0; i < kObjects; ++i) {
    items[i].patch = cycle->inputs[i].patch;
    items[i].host_camera = cycle->inputs[i].host_camera;
    items[i].theta = cycle->scenes[i].theta_start;
    poses->push_back(cycle->scenes[i].T_start);
  }
  const auto batch = std::make_shared<tp::TextBatch>(items.data(), kObjects);
  const auto result = std::make_shared<tp::TextBatchResult>(*batch);
  const auto run = [=, &first] {
    return tp::linearise_batch<kUnknowns>(*batch, first.target_view(), first.camera, poses->data(), options(true),
                                          *result);
  };
  run();
  Work work;
  work.items = kObjects * n;
  for (std::size_t i = 0; i < kObjects; ++i) {
    tp::PhotometricInput in = cycle->inputs[i];
    in.target = first.target_view();
    const auto ours = result->normal_equations<kUnknowns>(static_cast<int>(i));
    const tp::ResidualRequest one{in, items[i].theta, (*poses)[i], options(true)};
    largest(errors_and_cost(ours, tp::reference::linearise<kUnknowns>(one, cycle->workspace)), &work.errors);
  }
  work.call = [run, cycle](std::size_t) { keep(run()); };
  return work;
}

}  // namespace

void add_equations() {
  for (const int n : {15, 64}) {
    add_targets("batch16_pose_plane", std::to_string(n), [=] { return batch_work<tp::Parameters::pose_plane>(n); });
    add_targets("batch16_pose", std::to_string(n), [=] { return batch_work<tp::Parameters::pose>(n); });
  }
  for (const int n : {15, 64, 256, 1000, 4000}) {
    const std::string size = std::to_string(n);
    const auto cycle = cycle_of(n);
    add_forward<tp::Parameters::pose_plane>("pose_plane", size, cycle);
    add_forward<tp::Parameters::pose_plane>("pose_plane_prepared", size, cycle_of(n, 4, true));
    add_forward<tp::Parameters::pose_plane>("pose_plane_cold", size, cycle_of(n, 24));
    add_forward<tp::Parameters::pose>("pose", size, cycle);
    add_forward<tp::Parameters::host_target_plane>("host_target_plane", size, cycle);
    add_policy<tp::Parameters::pose_plane>("template_l2", tp::LinearisePolicy::template_jacobian, false, size, cycle);
    add_policy<tp::Parameters::pose_plane>("template_l2_prepared", tp::LinearisePolicy::template_jacobian, false, size,
                                           cycle_of(n, 4, true));
    add_policy<tp::Parameters::pose_plane>("template_huber", tp::LinearisePolicy::template_jacobian, true, size, cycle);
    add_policy<tp::Parameters::pose_plane>("esm", tp::LinearisePolicy::esm, true, size, cycle);
    add_policy<tp::Parameters::pose_plane>("hybrid", tp::LinearisePolicy::hybrid, true, size, cycle);
    add_cost("cost", n, cycle);
  }
  add_forward<tp::Parameters::plane>("plane", "4000", cycle_of(4000));
  add_lens(tp::RadialTangential<double>{{}, -0.28, 0.07, 1e-3, -5e-4, 0});
  add_lens(tp::KannalaBrandt<double>{{}, 0.01, -0.003, 0.002, -0.001});
  add_lens(tp::DoubleSphere<double>{{}, -0.2, 0.6});
  // The same rectangles as for findTransformECC.
  for (const auto& [columns, rows] : {std::pair(16, 16), {40, 25}}) {
    const std::string size = std::to_string(columns) + "x" + std::to_string(rows);
    add_forward<tp::Parameters::pose_plane>("pose_plane", size, dense_cycle_of(columns, rows));
    add_policy<tp::Parameters::pose_plane>("template_l2", tp::LinearisePolicy::template_jacobian, false, size,
                                           dense_cycle_of(columns, rows));
  }
}

}  // namespace textplane_bench
