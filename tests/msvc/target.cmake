# The kernels for MSVC's target by clang++, where MinGW's headers stand in for MSVC's. Minutes.
if(NOT TEXTPLANE_TEST_LONG OR NOT all_tiers)
  return()
endif()
find_program(TEXTPLANE_COMPILER_clang++ clang++)
find_program(TEXTPLANE_COMPILER_mingw x86_64-w64-mingw32-g++-posix)
find_program(TEXTPLANE_NM nm)
find_path(TEXTPLANE_MINGW_HEADERS _mingw.h PATHS /usr/x86_64-w64-mingw32/include NO_DEFAULT_PATH)
if(NOT TEXTPLANE_COMPILER_clang++ OR NOT TEXTPLANE_COMPILER_mingw OR NOT TEXTPLANE_NM OR NOT TEXTPLANE_MINGW_HEADERS)
  message(STATUS "no clang++, nm or headers of MinGW: the kernels are not compiled for MSVC's target")
  return()
endif()
get_target_property(eigen Eigen3::Eigen INTERFACE_INCLUDE_DIRECTORIES)
add_test(NAME msvc.target COMMAND ${CMAKE_COMMAND} -DCLANG=${TEXTPLANE_COMPILER_clang++} -DGCC=${TEXTPLANE_COMPILER_mingw}
  -DMINGW=${TEXTPLANE_MINGW_HEADERS} -DEIGEN=${eigen} -DNM=${TEXTPLANE_NM} -DROOT=${PROJECT_SOURCE_DIR}
  -DOBJECT=${CMAKE_CURRENT_BINARY_DIR}/msvc_target.obj -P ${CMAKE_CURRENT_SOURCE_DIR}/msvc/target_test.cmake)
set_tests_properties(msvc.target PROPERTIES TIMEOUT 1200 COST 90)
textplane_label(msvc.target)
