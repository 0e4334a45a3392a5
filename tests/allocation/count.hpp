// What is allocated: calls of malloc, calloc, realloc and their aligned kin are counted (count.cpp). The global
// operator new and Eigen take their memory from there.
#ifndef TEXTPLANE_TESTS_ALLOCATION_COUNT_HPP
#define TEXTPLANE_TESTS_ALLOCATION_COUNT_HPP

#include <gtest/gtest.h>

namespace textplane_test {

long allocations();

/// Expects that nothing is allocated while it lives.
class NoAllocation {
 public:
  NoAllocation() : before_(allocations()) {}
  ~NoAllocation() {
    const long after = allocations();
    EXPECT_EQ(after, before_);
  }
  NoAllocation(const NoAllocation&) = delete;
  NoAllocation& operator=(const NoAllocation&) = delete;

 private:
  long before_;
};

}  // namespace textplane_test

#endif  // TEXTPLANE_TESTS_ALLOCATION_COUNT_HPP
