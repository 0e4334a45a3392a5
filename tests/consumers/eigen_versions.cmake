# Stand-ins for installed versions of Eigen, with the headers of EIGEN: 5.0.1, whose version file refuses a request for 3.3,
# is taken by the build of SOURCE and by its installed package; 3.2.10 is refused by both in one line.
# cmake -DSOURCE= -DTO= -DEIGEN= -DGENERATOR= -DCOMPILER= -P eigen_versions.cmake
cmake_minimum_required(VERSION 3.21)
file(REMOVE_RECURSE ${TO})

# configure(OUT VERSION SOURCE OPTION...): configures with that version; OUT is what CMake said, OUT_result its exit code.
function(configure out version source)
  set(fake ${TO}/eigen-${version})
  file(WRITE ${fake}/Eigen3Config.cmake "
    add_library(Eigen3::Eigen INTERFACE IMPORTED)
    set_target_properties(Eigen3::Eigen PROPERTIES INTERFACE_INCLUDE_DIRECTORIES \"${EIGEN}\")\n")
  string(REGEX MATCH "^[0-9]+" major ${version})
  file(WRITE ${fake}/Eigen3ConfigVersion.cmake "
    set(PACKAGE_VERSION ${version})
    if(PACKAGE_FIND_VERSION AND NOT PACKAGE_FIND_VERSION_MAJOR EQUAL ${major})
      set(PACKAGE_VERSION_COMPATIBLE FALSE)
    else()
      set(PACKAGE_VERSION_COMPATIBLE TRUE)
    endif()\n")
  execute_process(COMMAND ${CMAKE_COMMAND} -S ${source} -B ${TO}/${out} -G ${GENERATOR} -DCMAKE_CXX_COMPILER=${COMPILER}
    -DEigen3_DIR=${fake} ${ARGN} OUTPUT_VARIABLE said ERROR_VARIABLE said RESULT_VARIABLE result)
  set(${out} "${said}" PARENT_SCOPE)
  set(${out}_result ${result} PARENT_SCOPE)
endfunction()

set(library -DTEXTPLANE_BUILD_TESTS=OFF -DTEXTPLANE_BUILD_EXAMPLES=OFF -DTEXTPLANE_BUILD_PYTHON=OFF)
set(consumer ${CMAKE_CURRENT_LIST_DIR}/find_package)
configure(build5 5.0.1 ${SOURCE} ${library})
if(NOT build5_result EQUAL 0)
  message(FATAL_ERROR "Eigen 5.0.1 is refused: ${build5}")
endif()
execute_process(COMMAND ${CMAKE_COMMAND} --install ${TO}/build5 --prefix ${TO}/prefix OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
configure(use5 5.0.1 ${consumer} -DCMAKE_PREFIX_PATH=${TO}/prefix)
if(NOT use5_result EQUAL 0)
  message(FATAL_ERROR "the package refuses Eigen 5.0.1: ${use5}")
endif()
configure(build3 3.2.10 ${SOURCE} ${library})
configure(use3 3.2.10 ${consumer} -DCMAKE_PREFIX_PATH=${TO}/prefix)
foreach(said IN ITEMS build3 use3)
  string(REGEX REPLACE "[ \n]+" " " ${said} "${${said}}")
  if(${said}_result EQUAL 0 OR NOT ${said} MATCHES "textplane needs Eigen 3\\.3 or later; [^ ]+ is 3\\.2\\.10")
    message(FATAL_ERROR "Eigen 3.2.10 is not refused: ${${said}}")
  endif()
endforeach()
