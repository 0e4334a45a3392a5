# Targets that this machine lacks, or has beyond what is wanted: an old CPU under qemu-user, and AVX-512 on emulated intrinsics.
# ctest -L emulation runs them alone.
if(NOT CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|AMD64)$" OR CMAKE_CROSSCOMPILING)
  return()
endif()

# Kernels and solvers on a CPU without AVX, as they are built for this machine. One test for ctest each: starting the emulator
# takes longer than most of their tests. (Features run on the kernels alone, but on images for which the emulator is too slow.)
find_program(TEXTPLANE_QEMU_X86_64 qemu-x86_64)
if(TEXTPLANE_QEMU_X86_64)
  foreach(room simd photometry solver)
    if(NOT TARGET test_${room})
      continue()
    endif()
    add_test(NAME emulation.nehalem.${room}
      COMMAND ${TEXTPLANE_QEMU_X86_64} -cpu Nehalem $<TARGET_FILE:test_${room}> --gtest_brief=1)
    set_tests_properties(emulation.nehalem.${room} PROPERTIES LABELS emulation TIMEOUT 600)
  endforeach()
else()
  message(STATUS "no qemu-x86_64: nothing is run on an old CPU")
endif()

# The AVX-512 bodies, with their lanes and masks, on AVX2.
find_path(TEXTPLANE_SIMDE simde/x86/avx512.h)
include(CheckCXXSourceRuns)
set(CMAKE_REQUIRED_FLAGS "-mavx2 -mfma -mpopcnt")
check_cxx_source_runs("int main() { return __builtin_cpu_supports(\"avx2\") && __builtin_cpu_supports(\"fma\") ? 0 : 1; }" TEXTPLANE_RUNS_AVX2)
unset(CMAKE_REQUIRED_FLAGS)
if(TEXTPLANE_SIMDE AND TEXTPLANE_RUNS_AVX2 AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/simd/*_test.cpp)
  add_executable(test_simd_avx512 ${sources} ${CMAKE_CURRENT_SOURCE_DIR}/simd/dispatch_fixed.cpp)
  target_link_libraries(test_simd_avx512 PRIVATE textplane_developer GTest::gtest GTest::gtest_main)
  target_include_directories(test_simd_avx512 PRIVATE ${CMAKE_CURRENT_SOURCE_DIR})
  target_include_directories(test_simd_avx512 SYSTEM PRIVATE ${TEXTPLANE_SIMDE})
  # 64-byte vectors are passed in memory then: their layout in a call is of no concern within one program.
  target_compile_options(test_simd_avx512 PRIVATE -O1 -g0 -mavx2 -mfma -mpopcnt -Wno-psabi -Wno-error)
  target_compile_definitions(test_simd_avx512 PRIVATE "TEXTPLANE_EMULATED_AVX512=\"simd/emulated_avx512.hpp\"")
  target_precompile_headers(test_simd_avx512 PRIVATE <gtest/gtest.h> <Eigen/Core> <Eigen/Geometry> <${CMAKE_CURRENT_SOURCE_DIR}/simd/emulated_avx512.hpp>
    <textplane/simd/residual.hpp> <textplane/simd/sample.hpp>)
  add_test(NAME emulation.avx512.simd COMMAND test_simd_avx512 --gtest_brief=1)
  set_tests_properties(emulation.avx512.simd PROPERTIES LABELS emulation TIMEOUT 600
    ENVIRONMENT TEXTPLANE_FORCE_TARGET=avx512 PASS_REGULAR_EXPRESSION "targets run:[a-z0-9 ]* avx512.emulated.[^|]*PASSED" FAIL_REGULAR_EXPRESSION "FAILED")
else()
  message(STATUS "no SIMDe, no AVX2 or not g++: the AVX-512 kernels are compiled, not run")
endif()
