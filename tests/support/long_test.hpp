// Tests that CI has no time for: scripts/test --all runs them, or a build with -DTEXTPLANE_TEST_LONG=ON.
#ifndef TESTS_SUPPORT_LONG_TEST_HPP
#define TESTS_SUPPORT_LONG_TEST_HPP

#include <gtest/gtest.h>

#ifdef TEXTPLANE_TEST_LONG
#define TEXTPLANE_LONG_TEST() static_cast<void>(0)
#else
#define TEXTPLANE_LONG_TEST() GTEST_SKIP() << "of scripts/test --all"
#endif

#endif  // TESTS_SUPPORT_LONG_TEST_HPP
