// textplane_convergence [TRIALS]: from how far off each method converges. TRIALS (200) starts in each of four scenes, 1
// to 16 px of mean corner error off, a 100 x 40 patch, one and three pyramid levels. Prints JSON, a row for each
// method, number of levels and distance: share of successes (final corner error below 0.5 px) in all and by scene,
// median final error of the successes, median time of a solve.
//
// "pose and plane": both are unknown and wrong at the start; 8 degrees of freedom, as for findTransformECC. "pose": the
// plane is known, as in a tracker, and refine_pose() solves.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <memory>
#include <string>

#include "convergence/trials.hpp"
#include "textplane/solver/pose.hpp"
#include "textplane/solver/search.hpp"

#if defined(TEXTPLANE_BENCH_OPENCV)
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>
#endif

namespace textplane_bench {

namespace {

using Policy = tp::LinearisePolicy;

struct Memory {
  tp::PhotometricWorkspace photometric{Trials::kColumns * Trials::kRows};
  tp::PoseWorkspace pose;
};

tp::SE3d search(const Trials& trials, const Start& s, Memory& memory) {
  return tp::search_pose(trials.patch, s.theta, s.T_t_h, trials.target_pyramid.view(), trials.camera, {},
                         memory.photometric, trials.prepared.data());
}

double solve_pose_and_plane(Policy policy, bool searched, const Trials& trials, int levels, Start s, Memory& memory) {
  if (searched) s.T_t_h = search(trials, s, memory);
  align(trials.patch, trials.prepared, levels, trials.target_pyramid.view(), trials.camera, policy, {}, 1e-3, 1e-3,
        memory.photometric, &s);
  return trials.corner_error(trials.homography(s));
}

double solve_pose(Policy policy, bool searched, const Trials& trials, int levels, Start s, Memory& memory) {
  tp::PoseTextTerm term;
  term.patch = &trials.patch;
  term.theta = s.theta;
  term.prepared = trials.prepared.data();
  memory.pose.reserve(&term, 1, 0);
  if (searched) s.T_t_h = search(trials, s, memory);
  tp::PoseOptions options;
  options.policy = policy;
  options.coarsest_level = levels - 1;
  s.T_t_h =
      tp::refine_pose(&term, 1, nullptr, 0, trials.target_pyramid.view(), trials.camera, s.T_t_h, options, memory.pose)
          .T_t_w;
  return trials.corner_error(trials.homography(s));
}

#if defined(TEXTPLANE_BENCH_OPENCV)
// The template's rectangle and the whole target on every level, coarse to fine.
double solve_ecc(const Trials& trials, int levels, const Start& s, Memory&) {
  tp::Matrix3<double> H = trials.homography(s);
  const auto mat = [](const tp::ImageView8& v) {
    return cv::Mat(v.height(), v.width(), CV_8U, const_cast<std::uint8_t*>(v.data()),
                   static_cast<std::size_t>(v.stride()));
  };
  for (int l = levels - 1; l >= 0; --l) {
    const int step = 1 << l;
    const cv::Rect box(Trials::kLeft / step, Trials::kTop / step, Trials::kColumns / step, Trials::kRows / step);
    // Level pixels are x_l = (x + 0.5) / 2^l - 0.5; those of the template count from its corner.
    tp::Matrix3<double> down = tp::Matrix3<double>::Identity(), corner = down;
    down(0, 0) = down(1, 1) = 1.0 / step;
    down(0, 2) = down(1, 2) = 0.5 / step - 0.5;
    corner(0, 2) = box.x;
    corner(1, 2) = box.y;
    tp::Matrix3<double> G = down * H * down.inverse() * corner;
    G /= G(2, 2);
    cv::Mat warp(3, 3, CV_32F);
    for (int i = 0; i < 9; ++i) warp.at<float>(i / 3, i % 3) = static_cast<float>(G(i / 3, i % 3));
    try {
      const auto level = static_cast<std::size_t>(l);
      cv::findTransformECC(mat(trials.host_pyramid.view().level[level])(box),
                           mat(trials.target_pyramid.view().level[level]), warp, cv::MOTION_HOMOGRAPHY,
                           cv::TermCriteria(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 50, 1e-4));
    } catch (const cv::Exception&) {
      return 1e3;  // how it says that it did not converge
    }
    for (int i = 0; i < 9; ++i) G(i / 3, i % 3) = static_cast<double>(warp.at<float>(i / 3, i % 3));
    H = down.inverse() * G * corner.inverse() * down;
  }
  return trials.corner_error(H);
}
#endif

struct Method {
  std::string name, unknowns;
  std::function<double(const Trials&, int, const Start&, Memory&)> solve;
  bool recommended = false, search = false;
};

std::vector<Method> methods() {
  std::vector<Method> out;
  const struct {
    const char* name;
    Policy policy;
    bool search;
  } ours[] = {{"forward", Policy::forward, false},
              {"template", Policy::template_jacobian, false},
              {"esm", Policy::esm, false},
              {"hybrid", Policy::hybrid, false},
              {"automatic", Policy::automatic, false},
              {"search, then automatic", Policy::automatic, true}};
  for (const bool plane : {true, false})
    for (const auto& [name, policy, searched] : ours) {
      const auto solve = plane ? solve_pose_and_plane : solve_pose;
      out.push_back(
          {name, plane ? "pose and plane" : "pose",
           [policy = policy, searched = searched, solve](const Trials& t, int levels, const Start& s, Memory& m) {
             return solve(policy, searched, t, levels, s, m);
           },
           searched && plane, searched});
    }
#if defined(TEXTPLANE_BENCH_OPENCV)
  out.push_back({"cv::findTransformECC", "pose and plane", solve_ecc});
#endif
  return out;
}

double median(std::vector<double> v) {
  if (v.empty()) return 0;
  std::nth_element(v.begin(), v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2), v.end());
  return v[v.size() / 2];
}

void run(unsigned trials) {
  std::vector<std::unique_ptr<Trials>> scenes;
  for (const Kind kind : kKinds) scenes.push_back(std::make_unique<Trials>(kind));
  Memory memory;
  const char* separator = "[\n";
  for (const Method& method : methods())
    for (const int levels : {1, Trials::kLevels}) {
      if (method.search && levels == 1) continue;  // it looks on the coarsest of them
      for (const double px : {1.0, 2.0, 4.0, 8.0, 12.0, 16.0}) {
        std::vector<double> errors, micros;
        std::string scene_successes;
        unsigned successes = 0;
        for (std::size_t k = 0; k < scenes.size(); ++k) {
          unsigned here = 0;
          for (unsigned i = 0; i < trials; ++i) {
            const Start s = scenes[k]->start(px, i, method.unknowns == "pose and plane");
            const auto begin = std::chrono::steady_clock::now();
            const double error = method.solve(*scenes[k], levels, s, memory);
            micros.push_back(
                std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - begin).count());
            if (!(error < 0.5)) continue;
            ++here;
            errors.push_back(error);
          }
          successes += here;
          scene_successes += std::string(k > 0 ? ", \"" : "\"") + to_string(kKinds[k]) + "\": " + std::to_string(here);
        }
        const auto count = trials * static_cast<unsigned>(scenes.size());
        std::printf(
            "%s {\"method\": \"%s\", \"unknowns\": \"%s\", \"levels\": %d, \"px\": %g, \"trials\": %u, "
            "\"success\": %.5f, \"by_scene\": {%s}, \"median_error\": %.4f, \"median_us\": %.1f, "
            "\"recommended\": %s}",
            separator, method.name.c_str(), method.unknowns.c_str(), levels, px, count,
            static_cast<double>(successes) / count, scene_successes.c_str(), median(errors), median(micros),
            method.recommended ? "true" : "false");
        std::fflush(stdout);
        separator = ",\n";
      }
    }
  std::printf("\n]\n");
}

}  // namespace

}  // namespace textplane_bench

int main(int argc, char** argv) {
#if defined(TEXTPLANE_BENCH_OPENCV)
  cv::setNumThreads(1);
#endif
  const int trials = argc > 1 ? std::atoi(argv[1]) : 200;
  if (trials < 1) {
    std::fprintf(stderr, "textplane_convergence: TRIALS must be at least 1\n");
    return 2;
  }
  textplane_bench::run(static_cast<unsigned>(trials));
}
