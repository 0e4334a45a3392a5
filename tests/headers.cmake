# What including a header must not do (manners_test.py), what must not compile and why, and that every adapter compiles alone and twice where its library is,
# and that a fixed target is the only one.
find_package(Python3 3.9 QUIET COMPONENTS Interpreter)
if(Python3_FOUND AND NOT CMAKE_CROSSCOMPILING)
  add_test(NAME headers.manners COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/manners_test.py ${PROJECT_SOURCE_DIR})
endif()
if(NOT CMAKE_CROSSCOMPILING AND CMAKE_CXX_COMPILER_ID MATCHES "GNU|Clang")
  get_target_property(eigen Eigen3::Eigen INTERFACE_INCLUDE_DIRECTORIES)
  add_test(NAME headers.compile_failures COMMAND ${CMAKE_COMMAND} -DCOMPILER=${CMAKE_CXX_COMPILER}
    "-DFLAGS=-DTEXTPLANE_EXTERN_KERNELS -I${PROJECT_SOURCE_DIR}/include -isystem ${eigen}" -DSOURCE=${CMAKE_CURRENT_SOURCE_DIR}/compile_failures.cpp
    -P ${CMAKE_CURRENT_SOURCE_DIR}/compile_failures.cmake)
  # As robots are built: without exceptions and run-time types, from the image to pose and plane.
  add_test(NAME headers.no_exceptions COMMAND ${CMAKE_COMMAND} -DMODE=variants -DVARIANTS=no_exceptions -DCOMPILER=${CMAKE_CXX_COMPILER}
    "-DFLAGS=-O0 -Wall -Wextra -Werror -fno-exceptions -fno-rtti -I${PROJECT_SOURCE_DIR}/include -isystem ${eigen}" -DSOURCE=${CMAKE_CURRENT_SOURCE_DIR}/simd/isa/mixed_unit.cpp
    -DMAIN=${CMAKE_CURRENT_SOURCE_DIR}/simd/isa/variants_main.cpp -DOBJECTS=${CMAKE_CURRENT_BINARY_DIR}/headers_ -P ${CMAKE_CURRENT_SOURCE_DIR}/simd/isa/isa_test.cmake)
  # With its target fixed a unit holds the kernels of that one alone.
  find_program(TEXTPLANE_NM nm)
  set(targets scalar)
  if(TEXTPLANE_RUNS_AVX512)
    list(APPEND targets avx512)
  elseif(TEXTPLANE_RUNS_AVX2)
    list(APPEND targets avx2)
  endif()
  if(TEXTPLANE_NM)
    add_test(NAME headers.fixed_target COMMAND ${CMAKE_COMMAND} -DMODE=fixed "-DTARGETS=${targets}" -DNM=${TEXTPLANE_NM} -DCOMPILER=${CMAKE_CXX_COMPILER}
      "-DFLAGS=-O0 -Wall -Wextra -Werror -I${PROJECT_SOURCE_DIR}/include -isystem ${eigen}" -DSOURCE=${CMAKE_CURRENT_SOURCE_DIR}/simd/isa/mixed_unit.cpp
      -DMAIN=${CMAKE_CURRENT_SOURCE_DIR}/simd/isa/variants_main.cpp -DOBJECTS=${CMAKE_CURRENT_BINARY_DIR}/headers_fixed_ -P ${CMAKE_CURRENT_SOURCE_DIR}/simd/isa/isa_test.cmake)
  endif()
endif()
if(NOT TEXTPLANE_TEST_INCLUDE_ALONE)
  return()
endif()
set(needs_ceres_pose Ceres::ceres)
set(needs_ceres Ceres::ceres)
set(needs_ceres_window Ceres::ceres)
set(needs_opencv opencv_core)
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
