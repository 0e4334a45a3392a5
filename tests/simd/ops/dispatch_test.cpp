#include "textplane/simd/dispatch.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>
#include <functional>
#include <string>
#include <vector>

#if defined(__wasm__) || defined(_WIN32)
#define TEXTPLANE_TEST_FORKS 0
#else
#define TEXTPLANE_TEST_FORKS 1
#include <sys/wait.h>
#include <unistd.h>
#endif
#if !defined(__wasm__)
#include <thread>
#endif

#include "simd/ops/dispatch_support.hpp"
#include "support/targets.hpp"

namespace textplane_test {
// dispatch_fixed.cpp
int fixed_active_target();
int fixed_dispatch();
bool fixed_set_target(int target);
}  // namespace textplane_test

namespace dispatch_test {

namespace simd = textplane::simd;
using simd::Target;
using textplane::Status;

constexpr Target kTargets[] = {Target::scalar, Target::sse41, Target::avx2,
                               Target::avx512, Target::neon,  Target::simd128};

/// Sets the variable, or with null removes it. Windows knows no empty variables: there the empty name removes it, too.
void set_environment(const char* target) {
#if defined(_WIN32)
  _putenv_s("TEXTPLANE_FORCE_TARGET", target == nullptr ? "" : target);
#else
  if (target == nullptr) {
    unsetenv("TEXTPLANE_FORCE_TARGET");
  } else {
    setenv("TEXTPLANE_FORCE_TARGET", target, 1);
  }
#endif
}

void force(const char* target) {
  set_environment(target);
  textplane::process::simd_target.store(-1);
}

/// The value of `body` in a child process that has not chosen its target yet and has TEXTPLANE_FORCE_TARGET = `target`.
/// WebAssembly has no processes, Windows does not copy them: there the program forgets its choice, and gets it back.
int in_fresh_process(const char* target, const std::function<int()>& body) {
#if !TEXTPLANE_TEST_FORKS
  const char* const set = std::getenv("TEXTPLANE_FORCE_TARGET");
  const std::string former = set == nullptr ? "" : set;
  const int chosen = textplane::process::simd_target.load();
  force(target);
  const int value = body();
  force(set == nullptr ? nullptr : former.c_str());
  textplane::process::simd_target.store(chosen);
  return value;
#else
  const pid_t child = fork();
  if (child == 0) {
    force(target);
    _exit(body());
  }
  int status = 0;
  if (child < 0 || waitpid(child, &status, 0) != child || !WIFEXITED(status)) return -1;
  return WEXITSTATUS(status);
#endif
}

int active() { return static_cast<int>(simd::active_target()); }
int forced_status() { return static_cast<int>(simd::forced_target_status()); }

TEST(Dispatch, NamesAndNumbersOfTargetsAgree) {
  for (const Target target : kTargets) {
    Target found = target == Target::scalar ? Target::neon : Target::scalar;
    EXPECT_TRUE(simd::target_from_string(simd::to_string(target), found));
    EXPECT_EQ(found, target);
  }
  Target untouched = Target::avx2;
  for (const char* wrong : {"", "avx", "avx2 ", "AVX2", "avx5123", "unknown", "scala"}) {
    EXPECT_FALSE(simd::target_from_string(wrong, untouched)) << wrong;
  }
  EXPECT_FALSE(simd::target_from_string(nullptr, untouched));
  EXPECT_EQ(untouched, Target::avx2);
  EXPECT_STREQ(simd::to_string(static_cast<Target>(99)), "unknown");
  EXPECT_FALSE(simd::supported(static_cast<Target>(99)));
}

TEST(Dispatch, ScalarIsAlwaysSupportedAndTheBestTargetIsTheWidest) {
  EXPECT_TRUE(simd::supported(Target::scalar));
  EXPECT_TRUE(simd::supported(simd::best_target()));
  for (const Target target : kTargets) {
    if (!simd::supported(target)) continue;
    EXPECT_LE(simd::lanes(target), simd::lanes(simd::best_target())) << to_string(target);
  }
}

// The compiler's own run-time library asks the same questions.
TEST(Dispatch, DetectionAgreesWithTheCompilersRuntime) {
#if TEXTPLANE_SIMD_ON_x86_wide && !defined(TEXTPLANE_EMULATED_AVX512)
  __builtin_cpu_init();
  EXPECT_EQ(simd::supported(Target::sse41), __builtin_cpu_supports("sse4.1") != 0);
  EXPECT_EQ(simd::supported(Target::avx2),
            __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("popcnt"));
  EXPECT_EQ(simd::supported(Target::avx512), __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
                                                 __builtin_cpu_supports("avx512dq") &&
                                                 __builtin_cpu_supports("avx512vl") &&
                                                 __builtin_cpu_supports("avx512vnni") && simd::supported(Target::avx2));
#else
  EXPECT_EQ(simd::supported(Target::neon), TEXTPLANE_SIMD_ON_arm != 0);
  EXPECT_EQ(simd::supported(Target::simd128), TEXTPLANE_SIMD_ON_wasm != 0);
#endif
}

TEST(Dispatch, EachTargetRunsItsOwnRegion) {
  for (const Target target : textplane_test::testable_targets()) {
    const textplane_test::TargetScope scope(target);
    EXPECT_EQ(simd::dispatched_region(), static_cast<int>(target));
    EXPECT_EQ(simd::dispatched_lanes(), simd::lanes(target));
  }
}

TEST(Dispatch, TheFirstUseTakesTheBestTarget) {
  EXPECT_EQ(in_fresh_process(nullptr, active), static_cast<int>(simd::best_target()));
  EXPECT_EQ(in_fresh_process("", active), static_cast<int>(simd::best_target()));
  EXPECT_EQ(in_fresh_process(nullptr, forced_status), static_cast<int>(Status::ok));
  EXPECT_EQ(in_fresh_process("", forced_status), static_cast<int>(Status::ok));
}

TEST(Dispatch, TheEnvironmentForcesASupportedTargetAndNoOther) {
  for (const Target target : kTargets) {
    const bool can = simd::supported(target);
    const Target expected = can ? target : simd::best_target();
    EXPECT_EQ(in_fresh_process(to_string(target), active), static_cast<int>(expected)) << to_string(target);
    EXPECT_EQ(in_fresh_process(to_string(target), forced_status),
              static_cast<int>(can ? Status::ok : Status::invalid_argument))
        << to_string(target);
  }
  EXPECT_EQ(in_fresh_process("avx1024", active), static_cast<int>(simd::best_target()));
  EXPECT_EQ(in_fresh_process("avx1024", forced_status), static_cast<int>(Status::invalid_argument));
}

TEST(Dispatch, TheEnvironmentIsReadOnce) {
  const auto body = [] {
    const int before = active();
    set_environment(to_string(simd::best_target()));
    return before == active() ? before : 100;
  };
  EXPECT_EQ(in_fresh_process("scalar", body), static_cast<int>(Target::scalar));
}

TEST(Dispatch, SetTargetBeforeTheFirstUseWinsOverTheEnvironment) {
  const Target best = simd::best_target();
  const auto body = [best] { return simd::set_target(best) == Status::ok ? active() : 100; };
  EXPECT_EQ(in_fresh_process("scalar", body), static_cast<int>(best));
}

TEST(Dispatch, SetTargetRefusesWhatTheMachineCannotRun) {
  const textplane_test::TargetScope scope(Target::scalar);
  for (const Target target : kTargets) {
    if (simd::supported(target)) continue;
    EXPECT_EQ(simd::set_target(target), Status::invalid_argument) << to_string(target);
    EXPECT_EQ(simd::active_target(), Target::scalar);
  }
  EXPECT_EQ(simd::set_target(static_cast<Target>(-1)), Status::invalid_argument);
  EXPECT_EQ(simd::set_target(static_cast<Target>(simd::kTargetCount)), Status::invalid_argument);
  EXPECT_EQ(simd::active_target(), Target::scalar);
}

TEST(Dispatch, AFixedTranslationUnitStaysOnItsTarget) {
  for (const Target target : textplane_test::testable_targets()) {
    const textplane_test::TargetScope scope(target);
    EXPECT_EQ(textplane_test::fixed_active_target(), static_cast<int>(Target::scalar));
    EXPECT_EQ(textplane_test::fixed_dispatch(), static_cast<int>(Target::scalar));
    EXPECT_EQ(simd::dispatched_region(), static_cast<int>(target)) << "its inline functions are not shared";
  }
  EXPECT_TRUE(textplane_test::fixed_set_target(static_cast<int>(Target::scalar)));
  EXPECT_FALSE(textplane_test::fixed_set_target(static_cast<int>(Target::avx2)));
  EXPECT_FALSE(textplane_test::fixed_set_target(static_cast<int>(Target::neon)));
}

#if !defined(__wasm__)  // which has threads only where the engine is told so
TEST(Dispatch, ThreadsThatArriveTogetherAgree) {
  const auto body = [] {
    int targets[8] = {};
    std::vector<std::thread> threads;
    for (int& target : targets) threads.emplace_back([&target] { target = active(); });
    for (std::thread& thread : threads) thread.join();
    for (const int target : targets) {
      if (target != targets[0]) return 100;
    }
    return targets[0];
  };
  EXPECT_EQ(in_fresh_process(nullptr, body), static_cast<int>(simd::best_target()));
  EXPECT_EQ(in_fresh_process("scalar", body), static_cast<int>(Target::scalar));
}
#endif

}  // namespace dispatch_test
