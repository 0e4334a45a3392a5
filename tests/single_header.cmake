# single_include/textplane.hpp: it is up to date, and, where asked for, all tests run on it.
option(TEXTPLANE_TEST_SINGLE_HEADER "Run all tests on single_include/textplane.hpp in place of include/" OFF)

find_package(Python3 3.9 QUIET COMPONENTS Interpreter)
if(Python3_FOUND AND NOT CMAKE_CROSSCOMPILING)
  add_test(NAME single_header.current COMMAND ${Python3_EXECUTABLE} ${PROJECT_SOURCE_DIR}/single_include/amalgamate.py --check)
  textplane_label(single_header.current first_look sanitizers)
  add_test(NAME single_header.script COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/single_header_test.py ${PROJECT_SOURCE_DIR})
  textplane_label(single_header.script first_look sanitizers)
endif()

# Headers that forward to it, found before those of include/. It has no adapters, and tests with kernels of their own
# take the list of regions from include/.
if(TEXTPLANE_TEST_SINGLE_HEADER)
  set(forward ${CMAKE_CURRENT_BINARY_DIR}/single_header)
  file(GLOB_RECURSE headers CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR}/include ${PROJECT_SOURCE_DIR}/include/textplane/*.hpp)
  foreach(header IN LISTS headers)
    if(NOT header MATCHES "/adapters/")
      file(CONFIGURE OUTPUT ${forward}/${header} CONTENT "#include \"@PROJECT_SOURCE_DIR@/single_include/textplane.hpp\"\n" @ONLY)
    endif()
  endforeach()
  target_include_directories(textplane BEFORE INTERFACE $<BUILD_INTERFACE:${forward}>)
endif()
