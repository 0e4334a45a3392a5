#include "textslam/common/bounded_sampler.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <string>

namespace textslam {
namespace {

TEST(BoundedSampler, AllOfFew) {
  BoundedSampler<int> thinned(10);
  for (int i = 0; i < 10; ++i) {
    thinned.add(100 + i);
    ASSERT_EQ(thinned.kept().size(), static_cast<std::size_t>(i + 1));
  }
  for (int i = 0; i < 10; ++i) EXPECT_EQ(*thinned.find(i), 100 + i);
}

TEST(BoundedSampler, EvenlySpreadAndBounded) {
  for (const std::size_t most : {1u, 2u, 7u, 10u}) {
    BoundedSampler<std::string> thinned(most);
    for (int n = 1; n <= 300; ++n) {
      thinned.add(std::to_string(n - 1));
      const auto& kept = thinned.kept();
      ASSERT_LE(kept.size(), most);
      ASSERT_GE(2 * kept.size(), std::min<std::size_t>(2 * static_cast<std::size_t>(n), most)) << n << " frames";
      const int step = kept.size() > 1 ? std::next(kept.begin())->first : n;
      int frame = 0;
      for (const auto& entry : kept) {
        ASSERT_EQ(entry.first, frame) << n << " frames";
        ASSERT_EQ(entry.second, std::to_string(frame));
        frame += step;
      }
      ASSERT_GE(frame, n) << "the last frames are left out";
    }
  }
}

TEST(BoundedSampler, LateValues) {
  BoundedSampler<int> thinned(4);
  for (int i = 0; i < 6; ++i) thinned.add(0);
  ASSERT_NE(thinned.find(4), nullptr);
  *thinned.find(4) = 7;
  EXPECT_EQ(thinned.kept().at(4), 7);
  EXPECT_EQ(thinned.find(3), nullptr) << "went when there were too many";
  EXPECT_EQ(thinned.find(6), nullptr) << "has not come";
  EXPECT_EQ(thinned.find(-1), nullptr);
}

}  // namespace
}  // namespace textslam
