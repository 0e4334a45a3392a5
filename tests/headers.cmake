# What including a header must not do (header_rules_test.py) and must include (header_includes_test.py); what must not
# compile; that every adapter compiles alone and twice if its library is there; that a unit with a fixed SIMD target has
# the kernels of no other. And that the texts that tests/mutants changes still stand in the headers.
find_package(Python3 3.9 QUIET COMPONENTS Interpreter)
if(Python3_FOUND AND NOT CMAKE_CROSSCOMPILING)
  add_test(NAME mutants.texts COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/mutants/run --check)
  add_test(NAME headers.rules COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/header_rules_test.py ${PROJECT_SOURCE_DIR})
  textplane_label(headers.rules first_look sanitizers)
  add_test(NAME headers.includes COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/header_includes_test.py ${PROJECT_SOURCE_DIR})
  textplane_label(headers.includes first_look sanitizers)
endif()
if(NOT CMAKE_CROSSCOMPILING AND CMAKE_CXX_COMPILER_ID MATCHES "GNU|Clang")
  get_target_property(eigen Eigen3::Eigen INTERFACE_INCLUDE_DIRECTORIES)
  add_test(NAME headers.compile_failures COMMAND ${CMAKE_COMMAND} -DCOMPILER=${CMAKE_CXX_COMPILER}
    "-DFLAGS=-DTEXTPLANE_EXTERN_KERNELS -I${PROJECT_SOURCE_DIR}/include -isystem ${eigen}" -DSOURCE=${CMAKE_CURRENT_SOURCE_DIR}/compile_failures.cpp
    -P ${CMAKE_CURRENT_SOURCE_DIR}/compile_failures.cmake)
  textplane_label(headers.compile_failures sanitizers)
  # Without exceptions and run-time types, as robots are built. A minute.
  if(TEXTPLANE_TEST_LONG)
    add_test(NAME headers.eigen_settings COMMAND ${CMAKE_COMMAND} -DCOMPILER=${CMAKE_CXX_COMPILER}
      "-DFLAGS=-O0 -Wall -Wextra -Werror -DTEXTPLANE_TARGET=scalar -fno-exceptions -fno-rtti -I${PROJECT_SOURCE_DIR}/include -isystem ${eigen}"
      -DSOURCE=${CMAKE_CURRENT_SOURCE_DIR}/eigen_settings.cpp -DOBJECTS=${CMAKE_CURRENT_BINARY_DIR}/headers_
      -P ${CMAKE_CURRENT_SOURCE_DIR}/eigen_settings.cmake)
    textplane_label(headers.eigen_settings)
  endif()
  # A unit whose target is fixed holds the kernels of that target alone: of the widest here, as scalar is fixed above. A minute and a half.
  find_program(TEXTPLANE_NM nm)
  set(targets scalar)
  if(TEXTPLANE_RUNS_AVX512)
    set(targets avx512)
  elseif(TEXTPLANE_RUNS_AVX2)
    set(targets avx2)
  endif()
  if(TEXTPLANE_NM AND TEXTPLANE_TEST_LONG)
    add_test(NAME headers.fixed_target COMMAND ${CMAKE_COMMAND} -DMODE=fixed "-DTARGETS=${targets}" -DNM=${TEXTPLANE_NM} -DCOMPILER=${CMAKE_CXX_COMPILER}
      "-DFLAGS=-O0 -Wall -Wextra -Werror -I${PROJECT_SOURCE_DIR}/include -isystem ${eigen}" -DSOURCE=${CMAKE_CURRENT_SOURCE_DIR}/simd/isa/mixed_unit.cpp
      -DMAIN=${CMAKE_CURRENT_SOURCE_DIR}/simd/isa/variants_main.cpp -DOBJECTS=${CMAKE_CURRENT_BINARY_DIR}/headers_fixed_ -P ${CMAKE_CURRENT_SOURCE_DIR}/simd/isa/isa_test.cmake)
    textplane_label(headers.fixed_target)
  endif()
endif()
# Every header compiles after a using-directive and the macros of windows.h, which hide std::min and std::max. Templates need not be used
# for that: their names are looked up where they are defined.
file(GLOB_RECURSE headers CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR}/include ${PROJECT_SOURCE_DIR}/include/textplane/*.hpp)
list(FILTER headers EXCLUDE REGEX "/adapters/")
set(others)
list(APPEND headers textplane/adapters/sophus.hpp)
if(TARGET opencv_core)
  list(APPEND headers textplane/adapters/opencv.hpp)
  string(APPEND others "#include <opencv2/core.hpp>\n")
endif()
if(TARGET Ceres::ceres)
  list(APPEND headers textplane/adapters/ceres_window.hpp textplane/adapters/ceres_text_map.hpp)  # which include the others
  string(APPEND others "#include <ceres/ceres.h>\n")
endif()
list(TRANSFORM headers REPLACE "(.+)" "#include <\\1>")
list(JOIN headers "\n" all_headers)
if(all_tiers)
  configure_file(careless_unit.cpp.in careless_unit.cpp @ONLY)
  add_library(careless_unit OBJECT ${CMAKE_CURRENT_BINARY_DIR}/careless_unit.cpp)
  target_link_libraries(careless_unit PRIVATE textplane_developer $<TARGET_NAME_IF_EXISTS:opencv_core> $<TARGET_NAME_IF_EXISTS:Ceres::ceres>)
  target_compile_options(careless_unit PRIVATE $<$<CXX_COMPILER_ID:GNU,Clang,AppleClang>:-O0 -g0 -Wdouble-promotion>)
endif()

# With matrices stored by rows, kernels get the numbers that they expect: tests that compare them with the reference,
# with differences and with known truth, as header-only programs compile them.
if(TEXTPLANE_TEST_LONG AND all_tiers AND NOT CMAKE_CROSSCOMPILING)
  set(by_rows core/se3 geometry/plane_fit photometry/residual_jacobian simd/batch_kernels simd/esm_kernels
    simd/residual_kernels simd/template_kernels solver/pose solver/window_linear)
  list(TRANSFORM by_rows APPEND _test.cpp)
  add_executable(test_stored_by_rows ${by_rows} support/dense.cpp)
  # Each unit compiles all kernels.
  set_target_properties(test_stored_by_rows PROPERTIES UNITY_BUILD ${TEXTPLANE_UNITY_BUILD} UNITY_BUILD_BATCH_SIZE 5)
  set_source_files_properties(support/dense.cpp solver/window_linear_test.cpp PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  target_link_libraries(test_stored_by_rows PRIVATE textplane_developer GTest::gtest GTest::gtest_main)
  target_include_directories(test_stored_by_rows PRIVATE ${CMAKE_CURRENT_SOURCE_DIR})
  target_compile_definitions(test_stored_by_rows PRIVATE EIGEN_DEFAULT_TO_ROW_MAJOR)
  target_compile_options(test_stored_by_rows PRIVATE ${TEXTPLANE_TEST_FLAGS} $<$<CXX_COMPILER_ID:GNU>:-Wdouble-promotion>)
  textplane_discover_tests(test_stored_by_rows headers.stored_by_rows)
endif()
if(NOT TEXTPLANE_TEST_LONG OR NOT all_tiers)
  return()
endif()
set(needs_ceres_pose Ceres::ceres)
set(needs_ceres_text_rows Ceres::ceres)
set(needs_ceres Ceres::ceres)
set(needs_ceres_window Ceres::ceres)
set(needs_ceres_text_map Ceres::ceres)
set(needs_opencv opencv_core)
set(needs_opencv_lens opencv_calib3d)
set(needs_sophus textplane)
file(GLOB adapters CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/include/textplane/adapters/*.hpp)
foreach(header IN LISTS adapters)
  get_filename_component(name ${header} NAME_WE)
  if(NOT DEFINED needs_${name})
    message(FATAL_ERROR "tests/headers.cmake does not know what adapters/${name}.hpp needs")
  endif()
  if(NOT TARGET ${needs_${name}})
    continue()
  endif()
  set(source ${CMAKE_CURRENT_BINARY_DIR}/alone/adapters_${name}.cpp)
  file(CONFIGURE OUTPUT ${source} CONTENT "#include <textplane/adapters/@name@.hpp>\n#include <textplane/adapters/@name@.hpp>\n" @ONLY)
  add_library(include_alone_${name} OBJECT ${source})
  target_link_libraries(include_alone_${name} PRIVATE textplane_developer ${needs_${name}})
endforeach()
