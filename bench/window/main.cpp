// textplane_scaling [--repetitions N] [--only PART_OF_A_NAME] [--cpu NAME]
//
// solve_window() and Ceres on windows of growing size: time, memory, iterations, cost, and the difference of the
// results. Prints JSON, from which report_scaling writes the table of docs/scaling.md.
#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "statistics.hpp"
#include "stopwatch.hpp"
#include "textplane/solver/window.hpp"
#include "window/ceres.hpp"
#include "window/heap.hpp"
#include "window/scene_window.hpp"

namespace textplane_bench {

namespace {

using Json = nlohmann::ordered_json;

const WindowSize kSizes[] = {
    {Path::walk, 5, 100, 10},     {Path::walk, 5, 1000, 10},     {Path::walk, 10, 1000, 50},
    {Path::walk, 20, 100, 500},   {Path::walk, 20, 1000, 50},    {Path::walk, 20, 10000, 0},
    {Path::walk, 50, 100, 50},    {Path::walk, 50, 1000, 10},    {Path::walk, 50, 1000, 50},
    {Path::walk, 50, 1000, 500},  {Path::walk, 50, 10000, 0},    {Path::walk, 50, 10000, 50},
    {Path::walk, 100, 1000, 50},  {Path::walk, 200, 1000, 50},   {Path::walk, 200, 1000, 500},
    {Path::walk, 200, 10000, 50}, {Path::walk, 200, 10000, 500}, {Path::stare, 5, 10000, 500},
    {Path::stare, 10, 1000, 50},  {Path::stare, 20, 1000, 50},   {Path::stare, 50, 100, 10},
    {Path::stare, 50, 1000, 50},  {Path::stare, 50, 10000, 50},  {Path::stare, 100, 1000, 50},
    {Path::stare, 200, 1000, 50},
};

constexpr int kLocal = 50;        // Key frames of a local window, which is measured more closely.
constexpr double kEnough = 3000;  // Processor time for one size after which three repetitions do, ms.

// Without covariances of planes, which Ceres computes in another call.
tp::WindowOptions timed() {
  tp::WindowOptions o;
  o.max_iterations = 50;
  o.covariance = false;
  return o;
}

// Runs both to the optimum: precise kernels, small tolerances, more iterations.
tp::WindowOptions exact() {
  tp::WindowOptions o = timed();
  o.max_iterations = 200;
  o.cost_tolerance = 1e-10;
  o.photometric.precise = true;
  return o;
}

struct Solution {
  tp::Window window;
  std::vector<double> ms, cpu_ms, build_ms;
  std::size_t bytes = 0;
  int iterations = 0;
  double cost = 0;
  bool converged = false;
};

void solve_ours(const tp::Window& start, const tp::WindowOptions& options, Solution* out) {
  out->window = start;
  start_heap_peak();
  {
    const Stopwatch watch;
    tp::WindowWorkspace workspace;
    const tp::WindowSummary summary = tp::solve_window(out->window, options, workspace);
    out->ms.push_back(watch.ms());
    out->cpu_ms.push_back(watch.cpu_ms());
    out->iterations = summary.iterations;
    out->cost = summary.final_cost;
    out->converged = summary.status == tp::Status::converged;
  }
  out->bytes = heap_peak();
}

void solve_ceres(const tp::Window& start, const tp::WindowOptions& options, CeresSolver solver, Solution* out) {
  out->window = start;
  start_heap_peak();
  const CeresResult result = solve_with_ceres(out->window, options, solver);
  out->bytes = heap_peak();
  out->ms.push_back(result.solve_ms);
  out->cpu_ms.push_back(result.cpu_ms);
  out->build_ms.push_back(result.build_ms);
  out->iterations = result.iterations;
  out->cost = result.final_cost;
  out->converged = result.converged;
}

Json describe(const Solution& s) {
  Json out = {{"ms_min", least(s.ms)},         {"ms_median", median(s.ms)},
              {"cpu_ms_min", least(s.cpu_ms)}, {"cpu_ms_median", median(s.cpu_ms)},
              {"repetitions", s.ms.size()},    {"bytes", s.bytes},
              {"iterations", s.iterations},    {"final_cost", s.cost},
              {"converged", s.converged}};
  if (!s.build_ms.empty()) out["build_ms_min"] = least(s.build_ms);
  return out;
}

// The largest differences: positions of cameras and points in m, angles in rad, costs and planes relative.
Json difference(const Solution& ours, const Solution& peer) {
  const tp::Window &a = ours.window, &b = peer.window;
  double position = 0, rotation = 0, point = 0, plane = 0;
  for (std::size_t f = 0; f < a.frames.size(); ++f) {
    const tp::SE3d T = a.frames[f].T_w_c.inverse() * b.frames[f].T_w_c;
    position = std::max(position, T.t.norm());
    rotation = std::max(rotation, tp::so3_log(T.R).norm());
  }
  for (std::size_t p = 0; p < a.points.size(); ++p) point = std::max(point, (a.points[p].p_w - b.points[p].p_w).norm());
  for (std::size_t t = 0; t < a.texts.size(); ++t)
    plane = std::max(plane, (a.texts[t].theta - b.texts[t].theta).norm() / a.texts[t].theta.norm());
  return {{"cost", (peer.cost - ours.cost) / ours.cost},
          {"position", position},
          {"rotation", rotation},
          {"point", point},
          {"plane", plane}};
}

// The same difference at the optimum.
Json optimum(const tp::Window& start) {
  Solution ours, sparse;
  solve_ours(start, exact(), &ours);
  solve_ceres(start, exact(), CeresSolver::sparse_schur, &sparse);
  return difference(ours, sparse);
}

Json measure(const WindowSize& size, int repetitions) {
  const SceneWindow start(size);
  Solution ours, sparse, dense;
  const bool with_dense = size.frames <= kLocal;
  const Stopwatch watch;
  // In turn, so that load from outside hits all alike; large windows get fewer repetitions.
  for (int i = 0; i < repetitions && (i < 3 || watch.cpu_ms() < kEnough); ++i) {
    solve_ours(start.window, timed(), &ours);
    solve_ceres(start.window, timed(), CeresSolver::sparse_schur, &sparse);
    if (with_dense) solve_ceres(start.window, timed(), CeresSolver::dense_schur, &dense);
  }
  Json out = {{"path", to_string(size.path)},
              {"frames", size.frames},
              {"points", size.points},
              {"texts", size.texts},
              {"point_observations", start.window.point_observations.size()},
              {"text_observations", start.window.text_observations.size()},
              {"ours", describe(ours)},
              {"sparse_schur", describe(sparse)}};
  if (with_dense) out["dense_schur"] = describe(dense);
  out["difference"] = difference(ours, sparse);
  if (size.frames <= kLocal) out["optimum"] = optimum(start.window);
  return out;
}

int run(int argc, char** argv) {
  int repetitions = 9;
  std::string only, cpu = "unknown CPU";
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string name = argv[i];
    if (name == "--repetitions") repetitions = std::max(std::atoi(argv[i + 1]), 1);
    if (name == "--only") only = argv[i + 1];
    if (name == "--cpu") cpu = argv[i + 1];
  }
  Json out = {{"cpu", cpu},
              {"compiler", TEXTPLANE_BENCH_COMPILER},
              {"flags", TEXTPLANE_BENCH_FLAGS},
              {"ceres", TEXTPLANE_BENCH_CERES},
              {"target", tp::simd::to_string(tp::simd::best_target())},
              {"repetitions", repetitions},
              {"rows", Json::array()}};
  for (const WindowSize& size : kSizes) {
    const std::string name = to_string(size.path) + "/" + std::to_string(size.frames) + "/" +
                             std::to_string(size.points) + "/" + std::to_string(size.texts);
    if (name.find(only) == std::string::npos) continue;
    out["rows"].push_back(measure(size, repetitions));
    std::cerr << out["rows"].back().dump() << std::endl;
  }
  std::cout << out.dump(1) << "\n";
  return 0;
}

}  // namespace

}  // namespace textplane_bench

int main(int argc, char** argv) { return textplane_bench::run(argc, argv); }
