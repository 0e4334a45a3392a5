# Tests of the Python package, in one process of pytest: docs/python.md.
if(NOT TEXTPLANE_BUILD_PYTHON)
  return()
endif()
execute_process(COMMAND ${Python_EXECUTABLE} -c "import pytest" RESULT_VARIABLE result ERROR_QUIET)
if(NOT result STREQUAL "0")
  message(STATUS "pytest not found: the Python package is not tested")
  return()
endif()
add_executable(python_numbers python/numbers.cpp)
target_link_libraries(python_numbers PRIVATE textplane_developer textplane::kernels)
set(python_environment PYTHONPATH=${CMAKE_BINARY_DIR}/python PYTHONDONTWRITEBYTECODE=1
  TEXTPLANE_NUMBERS=$<TARGET_FILE:python_numbers> TEXTPLANE_PYTHON=${PROJECT_SOURCE_DIR}/bindings/python)
add_test(NAME python.package COMMAND ${CMAKE_COMMAND} -E env ${python_environment}
  ${Python_EXECUTABLE} -m pytest -q -p no:cacheprovider ${CMAKE_CURRENT_SOURCE_DIR}/python)
textplane_label(python.package)
set_tests_properties(python.package PROPERTIES TIMEOUT 1200)
