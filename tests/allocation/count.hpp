// What is allocated: calls of the global operator new are counted (count.cpp), and Eigen, whose own memory does not
// come from there, is forbidden to allocate where NoAllocation says so; a violation stops the program with Eigen's
// message.
#ifndef TEXTPLANE_TESTS_ALLOCATION_COUNT_HPP
#define TEXTPLANE_TESTS_ALLOCATION_COUNT_HPP

#include <gtest/gtest.h>

#include <Eigen/Core>

#if !defined(EIGEN_RUNTIME_NO_MALLOC) || defined(NDEBUG)
#error "this program is built with EIGEN_RUNTIME_NO_MALLOC and with assertions"
#endif

namespace textplane_test {

long allocations();

/// Expects that nothing is allocated while it lives.
class NoAllocation {
 public:
  NoAllocation() : before_(allocations()) { Eigen::internal::set_is_malloc_allowed(false); }
  ~NoAllocation() {
    Eigen::internal::set_is_malloc_allowed(true);
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
