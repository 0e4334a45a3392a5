// Double precision with Eigen, automatic differentiation with Ceres, and numeric differences, on the scenes of our
// kernels. Each is checked against the double reference first.
#include <algorithm>
#include <cmath>
#include <memory>

#include "compare.hpp"
#include "peers/eigen.hpp"
#include "registry.hpp"
#include "scene.hpp"
#if defined(TEXTPLANE_BENCH_CERES)
#include "peers/ceres.hpp"
#include "peers/numeric.hpp"
#endif

namespace textplane_bench {

namespace {

constexpr std::size_t kScenes = 4;

std::shared_ptr<std::vector<Scene>> scenes(int n) {
  auto out = std::make_shared<std::vector<Scene>>();
  for (std::size_t i = 0; i < kScenes; ++i) out->push_back(make_scene(n, static_cast<unsigned>(i + 1)));
  return out;
}

template <int P>
tp::NormalEquations<P> normal_equations(const Equations& peer) {
  tp::NormalEquations<P> out;
  out.H = Eigen::Map<const Eigen::Matrix<double, P, P, Eigen::RowMajor>>(peer.H);
  out.b = Eigen::Map<const Eigen::Matrix<double, P, 1>>(peer.b);
  return out;
}

template <int P>
tp::NormalEquations<P> reference(const Scene& s, bool huber) {
  tp::PhotometricWorkspace workspace(s.n());
  constexpr tp::Parameters kUnknowns = P == 9 ? tp::Parameters::pose_plane : tp::Parameters::pose;
  const tp::ResidualRequest request{s.input(), s.theta_start, s.T_start, options(huber)};
  return tp::reference::linearise<kUnknowns>(request, workspace);
}

template <int P>
Work eigen_work(int n) {
  const auto all = scenes(n);
  const auto run = P == 9 ? baseline_pose_plane : baseline_pose;
  Work work;
  work.items = n;
  for (const Scene& s : *all) {
    Equations e;
    run(s.problem(), &e);
    largest(errors(normal_equations<P>(e), reference<P>(s, true)), &work.errors);
  }
  const auto out = std::make_shared<Equations>();
  work.call = [=](std::size_t i) {
    run((*all)[i % kScenes].problem(), out.get());
    keep(out->cost);
  };
  return work;
}

#if defined(TEXTPLANE_BENCH_CERES)
Work ceres_work(int n, bool equations) {
  const auto all = scenes(n);
  const auto costs = std::make_shared<std::vector<std::unique_ptr<CeresCost>>>();
  Work work;
  work.items = n;
  for (const Scene& s : *all) {
    costs->push_back(std::make_unique<CeresCost>(s.problem()));
    Equations e;
    costs->back()->equations(&e);
    largest(errors(normal_equations<9>(e), reference<9>(s, false)), &work.errors);
  }
  const auto out = std::make_shared<Equations>();
  work.call = [=, kept = all](std::size_t i) {  // the costs point into the scenes
    CeresCost& cost = *(*costs)[i % kScenes];
    if (equations) {
      cost.equations(out.get());
    } else {
      cost.rows();
    }
  };
  return work;
}

Work numeric_work(int n) {
  const auto all = scenes(n);
  const auto costs = std::make_shared<std::vector<std::unique_ptr<NumericCost>>>();
  Work work;
  work.items = n - n % 8;
  for (const Scene& s : *all) {
    costs->push_back(std::make_unique<NumericCost>(s.problem()));
    costs->back()->rows();
    // Only the columns of theta do not depend on how the pose is parametrised.
    std::vector<double> theirs, r(static_cast<std::size_t>(n)), J(static_cast<std::size_t>(3 * n));
    const int rows = costs->back()->theta_rows(&theirs);
    tp::PhotometricWorkspace workspace(n);
    tp::PhotometricOptions frozen = options(false);
    frozen.normalisation = tp::Normalisation::frozen;
    tp::reference::residuals<tp::Parameters::plane>(tp::ResidualRequest{s.input(), s.theta_start, s.T_start, frozen},
                                                    workspace, r.data(), J.data());
    double worst = 0, scale = 0;
    for (std::size_t k = 0; k < static_cast<std::size_t>(3 * rows); ++k) {
      worst = std::max(worst, std::abs(theirs[k] - J[k]));
      scale = std::max(scale, std::abs(J[k]));
    }
    work.errors["error_J"] = std::max(work.errors["error_J"], worst / scale);
  }
  work.call = [=, kept = all](std::size_t i) { (*costs)[i % kScenes]->rows(); };
  return work;
}
#endif

}  // namespace

void add_straightforward() {
#if defined(TEXTPLANE_BENCH_CERES)
  benchmark::AddCustomContext("Ceres", TEXTPLANE_BENCH_CERES);
#endif
  for (const int n : {15, 64, 256, 1000, 4000}) {
    const std::string size = "/native/" + std::to_string(n);
    add("eigen_double_9" + size, [=] { return eigen_work<9>(n); });
    add("eigen_double_6" + size, [=] { return eigen_work<6>(n); });
#if defined(TEXTPLANE_BENCH_CERES)
    add("ceres_rows" + size, [=] { return ceres_work(n, false); });
    add("ceres_equations" + size, [=] { return ceres_work(n, true); });
    add("numeric_differences" + size, [=] { return numeric_work(n); });
#endif
  }
}

}  // namespace textplane_bench
