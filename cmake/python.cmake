# What the Python package needs: an interpreter with NumPy, its headers, and pybind11. Sets textplane_python_missing to what
# is not there; empty: nothing. Of the interpreters in question the first with NumPy is taken: `python3` may be one without.
set(textplane_python_missing)
if(NOT Python_EXECUTABLE)
  foreach(candidate python3 /usr/bin/python3)
    execute_process(COMMAND ${candidate} -c "import sys, numpy; print(sys.executable)" OUTPUT_VARIABLE found
      RESULT_VARIABLE result OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
    if(result STREQUAL "0")
      set(Python_EXECUTABLE ${found} CACHE FILEPATH "The interpreter that the Python package is built for")
      break()
    endif()
  endforeach()
endif()
find_package(Python 3.9 QUIET COMPONENTS Interpreter Development.Module NumPy)
if(NOT Python_FOUND)
  list(APPEND textplane_python_missing "Python 3.9 with NumPy and headers")
endif()
set(PYBIND11_NOPYTHON ON)  # its own search takes the first interpreter
find_package(pybind11 2.6 QUIET CONFIG)
if(NOT pybind11_FOUND)
  list(APPEND textplane_python_missing pybind11)
endif()
