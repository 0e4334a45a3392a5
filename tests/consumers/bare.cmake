# A machine with Eigen alone: configuring SOURCE at top level succeeds, says in one line what is left out, builds and installs.
# cmake -DSOURCE= -DTO= -DEIGEN= -DGENERATOR= -DCOMPILER= -P bare.cmake
cmake_minimum_required(VERSION 3.21)
file(REMOVE_RECURSE ${TO})
set(absent)
foreach(package GTest JPEG PNG CLI11 nlohmann_json yaml-cpp SQLite3 Python pybind11)
  list(APPEND absent -DCMAKE_DISABLE_FIND_PACKAGE_${package}=ON)
endforeach()
execute_process(COMMAND ${CMAKE_COMMAND} -S ${SOURCE} -B ${TO}/build -G ${GENERATOR} -DCMAKE_CXX_COMPILER=${COMPILER}
  -DEigen3_DIR=${EIGEN} ${absent} -DSTB_INCLUDE_DIR=STB_INCLUDE_DIR-NOTFOUND OUTPUT_VARIABLE said COMMAND_ERROR_IS_FATAL ANY)
set(expected "textplane: left out: tests \\(no GoogleTest\\); examples \\(no JPEG, PNG, CLI11, nlohmann_json, yaml-cpp, SQLite3\\); the Python package \\(no Python 3.9 with NumPy and headers, pybind11\\)")
if(NOT said MATCHES "${expected}")
  message(FATAL_ERROR "what is left out is not said: ${said}")
endif()
execute_process(COMMAND ${CMAKE_COMMAND} --build ${TO}/build COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${CMAKE_COMMAND} --install ${TO}/build --prefix ${TO}/prefix OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
if(NOT EXISTS ${TO}/prefix/include/textplane/textplane.hpp)
  message(FATAL_ERROR "nothing is installed")
endif()
