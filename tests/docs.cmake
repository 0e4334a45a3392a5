# Tests of the pages (names, first program, reference, site) and of the style of the code.
add_test(NAME docs.names
  COMMAND ${CMAKE_COMMAND} -DROOT=${PROJECT_SOURCE_DIR} -P ${CMAKE_CURRENT_SOURCE_DIR}/docs_test.cmake)
textplane_label(docs.names first_look)
add_test(NAME docs.first_minutes
  COMMAND ${CMAKE_COMMAND} -DROOT=${PROJECT_SOURCE_DIR} -P ${CMAKE_CURRENT_SOURCE_DIR}/first_minutes.cmake)
textplane_label(docs.first_minutes first_look)
find_program(TEXTPLANE_DOXYGEN doxygen)
if(TEXTPLANE_DOXYGEN)
  add_test(NAME docs.reference COMMAND ${CMAKE_COMMAND} -DROOT=${PROJECT_SOURCE_DIR} -DDOXYGEN=${TEXTPLANE_DOXYGEN}
    -DTO=${CMAKE_CURRENT_BINARY_DIR}/reference -P ${CMAKE_CURRENT_SOURCE_DIR}/docs_reference.cmake)
  textplane_label(docs.reference first_look)
endif()

find_package(Python3 3.9 QUIET COMPONENTS Interpreter)
if(Python3_FOUND)
  add_test(NAME docs.readme_tables COMMAND ${Python3_EXECUTABLE} ${PROJECT_SOURCE_DIR}/scripts/readme_tables --check)
  textplane_label(docs.readme_tables first_look)
  if(TEXTPLANE_TEST_LONG)
    add_test(NAME docs.site COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/docs_site_test.py
      ${PROJECT_SOURCE_DIR} ${CMAKE_CURRENT_BINARY_DIR}/site)
    textplane_label(docs.site)
    set_tests_properties(docs.site PROPERTIES SKIP_RETURN_CODE 77 TIMEOUT 1200)
  endif()
  foreach(check format columns file folder function)
    add_test(NAME style.${check}
      COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/style.py ${PROJECT_SOURCE_DIR} --only ${check})
    textplane_label(style.${check})
    set_tests_properties(style.${check} PROPERTIES SKIP_RETURN_CODE 77)
  endforeach()
endif()
