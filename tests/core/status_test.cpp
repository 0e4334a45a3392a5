#include "textplane/core/status.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace tp = textplane;

namespace status_test {

constexpr int kCount = static_cast<int>(tp::Status::unsupported) + 1;

TEST(StatusTest, OnlyTheFirstThreeCarryAResult) {
  for (int i = 0; i < kCount; ++i) EXPECT_EQ(tp::is_ok(static_cast<tp::Status>(i)), i < 3) << i;
}

TEST(StatusTest, EveryStatusHasItsOwnName) {
  std::set<std::string> names;
  for (int i = 0; i < kCount; ++i) names.insert(tp::to_string(static_cast<tp::Status>(i)));
  EXPECT_EQ(names.size(), static_cast<std::size_t>(kCount));
  EXPECT_EQ(names.count("unknown"), 0u);
  EXPECT_STREQ(tp::to_string(static_cast<tp::Status>(kCount)), "unknown");
  static_assert(tp::is_ok(tp::Status::converged), "usable in constant expressions");
}

}  // namespace status_test
