# Targets that this machine lacks, or has beyond what is wanted: an old CPU under qemu-user, and AVX-512 on emulated intrinsics.
# ctest -L emulation runs them alone.
if(NOT CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|AMD64)$" OR CMAKE_CROSSCOMPILING)
  return()
endif()

# Kernels and solvers on a CPU without AVX, as they are built for this machine, on the target that such a CPU has: the scalar one
# is no other there than here. One test for ctest each: starting the emulator takes longer than most of their tests. (Features
# run on the kernels alone, but on images for which the emulator is too slow.)
find_program(TEXTPLANE_QEMU_X86_64 qemu-x86_64)
if(TEXTPLANE_QEMU_X86_64)
  foreach(room simd vectors photometry solver)
    if(NOT TARGET test_${room})
      continue()
    endif()
    set(name emulation.nehalem.${room})
    add_test(NAME ${name} COMMAND ${TEXTPLANE_QEMU_X86_64} -cpu Nehalem $<TARGET_FILE:test_${room}> --gtest_brief=1)
    set_tests_properties(${name} PROPERTIES LABELS emulation TIMEOUT 600 COST 60 ENVIRONMENT TEXTPLANE_TEST_TARGET=sse41)
    if(room MATCHES "^(simd|vectors)$")  # the others do not go through the targets
      set_tests_properties(${name} PROPERTIES
        PASS_REGULAR_EXPRESSION "targets run:[a-z0-9 ]* sse41\n[^|]*PASSED" FAIL_REGULAR_EXPRESSION "FAILED")
    endif()
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
  # 64-byte vectors are passed in memory then: their layout in a call is of no concern within one program.
  add_library(textplane_emulated INTERFACE)
  target_link_libraries(textplane_emulated INTERFACE textplane_developer GTest::gtest GTest::gtest_main)
  target_include_directories(textplane_emulated INTERFACE ${CMAKE_CURRENT_SOURCE_DIR})
  target_include_directories(textplane_emulated SYSTEM INTERFACE ${TEXTPLANE_SIMDE})
  target_compile_options(textplane_emulated INTERFACE -O1 -g0 -mavx2 -mfma -mpopcnt -Wno-psabi -Wno-error)
  target_compile_definitions(textplane_emulated INTERFACE "TEXTPLANE_EMULATED_AVX512=\"simd/emulated_avx512.hpp\"")
  get_target_property(sources test_simd SOURCES)
  add_executable(test_simd_avx512 ${sources} ${PROJECT_SOURCE_DIR}/cmake/kernels.cpp)
  set_source_files_properties(${PROJECT_SOURCE_DIR}/cmake/kernels.cpp PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  target_compile_definitions(test_simd_avx512 PRIVATE TEXTPLANE_EXTERN_KERNELS)
  target_precompile_headers(test_simd_avx512 PRIVATE ${precompiled})
  set_target_properties(test_simd_avx512 PROPERTIES UNITY_BUILD ${TEXTPLANE_UNITY_BUILD} UNITY_BUILD_BATCH_SIZE 8)
  textplane_add_vector_tests(test_vectors_avx512)
  foreach(room simd vectors)
    target_link_libraries(test_${room}_avx512 PRIVATE textplane_emulated)
    add_test(NAME emulation.avx512.${room} COMMAND test_${room}_avx512 --gtest_brief=1)
    set_tests_properties(emulation.avx512.${room} PROPERTIES LABELS emulation TIMEOUT 600
      ENVIRONMENT TEXTPLANE_FORCE_TARGET=avx512 PASS_REGULAR_EXPRESSION "targets run:[a-z0-9 ]* avx512.emulated.[^|]*PASSED" FAIL_REGULAR_EXPRESSION "FAILED")
  endforeach()
else()
  message(STATUS "no SIMDe, no AVX2 or not g++: the AVX-512 kernels are compiled, not run")
endif()
