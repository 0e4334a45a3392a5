// Runs a test on every SIMD target that this machine has, and says at the end of the program which ones that were:
//
//   for (const simd::Target target : textplane_test::testable_targets()) {
//     const textplane_test::TargetScope scope(target);
//     SCOPED_TRACE(simd::to_string(target));
//     ...
//   }
#ifndef TEXTPLANE_TESTS_SUPPORT_TARGETS_HPP
#define TEXTPLANE_TESTS_SUPPORT_TARGETS_HPP

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#include "textplane/simd/dispatch.hpp"

namespace textplane_test {

namespace simd = textplane::simd;

/// Which targets a TargetScope has been opened for.
inline std::array<bool, simd::kTargetCount>& targets_run() {
  static std::array<bool, simd::kTargetCount> run{};
  return run;
}

/// The targets that this build holds and this machine runs, scalar first; or the one of them that TEXTPLANE_TEST_TARGET
/// names, for an emulator that is there for its sake.
inline std::vector<simd::Target> testable_targets() {
  const char* const only = std::getenv("TEXTPLANE_TEST_TARGET");
  std::vector<simd::Target> targets;
  for (int i = 0; i < simd::kTargetCount; ++i) {
    const auto target = static_cast<simd::Target>(i);
    if (simd::supported(target) && (only == nullptr || std::strcmp(only, simd::to_string(target)) == 0))
      targets.push_back(target);
  }
  if (targets.empty()) ADD_FAILURE() << "no target " << only;
  return targets;
}

/// Makes the kernels run on one target, and puts the former one back at the end.
class TargetScope {
 public:
  explicit TargetScope(simd::Target target) : former_(simd::active_target()) {
    EXPECT_EQ(simd::set_target(target), textplane::Status::ok) << simd::to_string(target);
    EXPECT_EQ(simd::active_target(), target);
    targets_run()[static_cast<std::size_t>(target)] = true;
  }
  ~TargetScope() { EXPECT_EQ(simd::set_target(former_), textplane::Status::ok); }
  TargetScope(const TargetScope&) = delete;
  TargetScope& operator=(const TargetScope&) = delete;

 private:
  simd::Target former_;
};

/// AVX-512 on emulated intrinsics is not the real thing.
inline const char* emulation(simd::Target target) {
#if defined(TEXTPLANE_EMULATED_AVX512)
  return target == simd::Target::avx512 ? "(emulated)" : "";
#else
  static_cast<void>(target);
  return "";
#endif
}

/// The closing lines of a test program.
class TargetReport : public ::testing::Environment {
 public:
  void TearDown() override {
    std::string run, skipped;
    for (int i = 0; i < simd::kTargetCount; ++i) {
      const auto target = static_cast<simd::Target>(i);
      if (targets_run()[static_cast<std::size_t>(i)])
        run += std::string(" ") + simd::to_string(target) + emulation(target);
      if (!simd::supported(target)) skipped += std::string(" ") + simd::to_string(target);
    }
    if (run.empty()) return;
    if (!skipped.empty()) std::printf("targets skipped, which this machine or build lacks:%s\n", skipped.c_str());
    std::printf("targets run:%s\n", run.c_str());
  }
};

inline ::testing::Environment* const target_report = ::testing::AddGlobalTestEnvironment(new TargetReport);

}  // namespace textplane_test

#endif  // TEXTPLANE_TESTS_SUPPORT_TARGETS_HPP
