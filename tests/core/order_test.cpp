// Medians, and an even choice.
#include "textplane/core/order.hpp"

#include <gtest/gtest.h>

namespace order_test {

using namespace textplane;

TEST(Order, TheMedianIsTheUpperOne) {
  EXPECT_EQ(median({}), 0);
  EXPECT_EQ(median({7}), 7);
  EXPECT_EQ(median({9, 1, 5}), 5);
  EXPECT_EQ(median({9, 1, 5, 3}), 5);
}

TEST(Order, AnEvenChoiceHasBothEnds) {
  const std::vector<int> ids = {10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20};
  EXPECT_EQ(evenly_spaced(ids, 3), std::vector<int>({10, 15, 20}));
  EXPECT_EQ(evenly_spaced(ids, 2), std::vector<int>({10, 20}));
  EXPECT_EQ(evenly_spaced(ids, 11), ids);
  EXPECT_EQ(evenly_spaced(ids, 50), ids);
  EXPECT_EQ(evenly_spaced(ids, 1), ids) << "there is no choice of one with both ends";
}

}  // namespace order_test
