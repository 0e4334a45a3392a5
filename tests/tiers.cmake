# Tiers: the sets of tests that scripts/test runs. A test names its tiers where it is declared; they and its room, the
# first word of its name, are its labels for ctest: `ctest -L '^first_look$'`. A test without a tier runs where all
# tests do.
#   first_look  scripts/test, minutes: the library
#   sanitizers  AddressSanitizer and UndefinedBehaviorSanitizer: the library, what reads files; in --all the programs
#   threads     ThreadSanitizer
#   library     other standards, -O0 and coverage: the library alone
#   fast_math   -ffast-math
set(TEXTPLANE_TEST_TIER "" CACHE STRING "Build the tests of one tier alone: first_look, sanitizers, threads, library or fast_math")

# textplane_in_tier(RESULT TIER...): whether tests of these tiers are built.
function(textplane_in_tier result)
  set(${result} OFF PARENT_SCOPE)
  if(NOT TEXTPLANE_TEST_TIER OR TEXTPLANE_TEST_TIER IN_LIST ARGN)
    set(${result} ON PARENT_SCOPE)
  endif()
endfunction()

# textplane_label(TEST TIER...): the labels of a test of add_test().
function(textplane_label test)
  string(REGEX MATCH "^[^.]*" room ${test})
  set_property(TEST ${test} APPEND PROPERTY LABELS ${room} ${ARGN})
endfunction()

# textplane_discover_tests(PROGRAM ROOM [LABELS LABEL...] [TIERS TIER...] [EXCEPT TIER REGEX...] [WHOLE SUITE...]): the
# tests of a program of GoogleTest. Those whose names match a REGEX of EXCEPT are not of that TIER. ctest sets the labels:
# GoogleTest's module takes no lists as properties. The tests of a SUITE share what takes long to make, so they are one
# test for ctest.
function(textplane_discover_tests program room)
  cmake_parse_arguments(tests "" "" "LABELS;TIERS;EXCEPT;WHOLE" ${ARGN})
  set(filter)
  if(tests_WHOLE AND CMAKE_VERSION VERSION_GREATER_EQUAL 3.22)
    list(TRANSFORM tests_WHOLE REPLACE "(.+)" "*\\1.*" OUTPUT_VARIABLE patterns)
    list(JOIN patterns ":" patterns)
    set(filter TEST_FILTER "-${patterns}")
    foreach(suite IN LISTS tests_WHOLE)
      add_test(NAME ${room}.${suite} COMMAND ${program} --gtest_filter=*${suite}.*)
      set_tests_properties(${room}.${suite} PROPERTIES TIMEOUT 600 COST 20)  # ctest begins with what costs most
      set(tiers_of_suite ${tests_TIERS})
      set(exceptions ${tests_EXCEPT})
      while(exceptions)
        list(POP_FRONT exceptions tier regex)
        if("${suite}." MATCHES "${regex}")
          list(REMOVE_ITEM tiers_of_suite ${tier})
        endif()
      endwhile()
      textplane_label(${room}.${suite} ${tests_LABELS} ${tiers_of_suite})
    endforeach()
  endif()
  gtest_discover_tests(${program} TEST_PREFIX ${room}. ${filter} DISCOVERY_TIMEOUT 60 PROPERTIES TIMEOUT 600)
  list(JOIN tests_TIERS " " tiers)
  list(JOIN tests_LABELS " " labels)
  set(labels "${room} ${labels} ${tiers}")
  set(exceptions)
  while(tests_EXCEPT)
    list(POP_FRONT tests_EXCEPT tier regex)
    string(APPEND exceptions "  if(test MATCHES [[${regex}]])\n    list(REMOVE_ITEM labels ${tier})\n  endif()\n")
  endwhile()
  set(file ${CMAKE_CURRENT_BINARY_DIR}/${program}_labels.cmake)
  configure_file(labels.cmake.in ${file} @ONLY)
  set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES ${file})
endfunction()
