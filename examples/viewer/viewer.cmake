# textplane_report_template(TARGET): the page of the report, in one piece, as a source of the target.
set(textplane_viewer ${CMAKE_CURRENT_LIST_DIR})
function(textplane_report_template target)
  set(generated ${CMAKE_CURRENT_BINARY_DIR}/generated)
  file(GLOB viewer CONFIGURE_DEPENDS ${textplane_viewer}/*)
  add_custom_command(OUTPUT ${generated}/report_template.cpp
    COMMAND ${CMAKE_COMMAND} -DVIEWER=${textplane_viewer} -DOUTPUT=${generated}/report_template.cpp
      -P ${textplane_viewer}/embed.cmake
    DEPENDS ${viewer} VERBATIM)
  target_sources(${target} PRIVATE ${generated}/report_template.cpp)
endfunction()
