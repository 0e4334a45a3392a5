# Tests of the example programs and of what they are made of. Their names begin with `examples.`.

# The adjustment and the detector beside tracking, with the files that they need and no more: ThreadSanitizer takes a
# minute for each.
if(TEXTPLANE_TEST_TIER STREQUAL "threads")
  set(alone adjust/adjuster adjust/adjustment adjust/adjustment_selection detect/detection_thread
    map/observations track/feature_tracks track/point_search track/rotation_prior track/track track/tracker
    track/tracker_pose)
  list(TRANSFORM alone REPLACE "(.+)" "${PROJECT_SOURCE_DIR}/examples/textslam/\\1.cpp")
  add_executable(adjuster_alone_test textslam/adjust/adjuster_test.cpp textslam/detect/detection_thread_test.cpp ${alone})
  target_include_directories(adjuster_alone_test PRIVATE ${PROJECT_SOURCE_DIR}/examples)
  target_link_libraries(adjuster_alone_test PRIVATE textplane_test_support GTest::gtest_main)
  target_compile_options(adjuster_alone_test PRIVATE ${TEXTPLANE_TEST_FLAGS})
  target_precompile_headers(adjuster_alone_test REUSE_FROM textplane_test_support)
  set_target_properties(adjuster_alone_test PROPERTIES UNITY_BUILD ${TEXTPLANE_UNITY_BUILD})
  textplane_discover_tests(adjuster_alone_test threads TIERS threads)
endif()

if(NOT TEXTPLANE_BUILD_EXAMPLES)
  return()
endif()

# Sanitizers see what reads files of others; in --all the programs, too, but neither whole runs nor statistics, and of
# the renderer a room and a corridor: its other kinds differ in numbers.
set(sanitizers)
if(TEXTPLANE_TEST_LONG)
  set(sanitizers sanitizers)
endif()
textplane_add_tests(io LIBRARIES textplane_io TIERS sanitizers)
textplane_add_tests(renderer LIBRARIES textplane_renderer TIERS ${sanitizers} EXCEPT
  sanitizers "RendererGeometry\\.EveryPixelShowsTheNearestSurfaceOnItsRay|RendererTruth\\.SignsPosesAndCamera"
  sanitizers "Kinds/EveryKind\\.RendersFramesThatATrackerCanUse/(lights|night|notext|rapid|room_still|sparse)")
textplane_add_tests(planar LIBRARIES textplane_textslam TIERS ${sanitizers})
textplane_add_tests(detectors LIBRARIES textplane_plugins LABELS textslam TIERS ${sanitizers} EXCEPT
  sanitizers "ClassicalDetector\\.FindsTheSignsOfClearRooms")
textplane_add_tests(textslam LIBRARIES textplane_plugins textplane_textslam_map TIERS ${sanitizers} EXCEPT
  sanitizers "LateDetections\\." WHOLE LateDetections FrameRate RollingRoom)
textplane_add_tests(map_file LIBRARIES textplane_textslam_map LABELS textslam TIERS ${sanitizers} EXCEPT
  sanitizers "AKill|MergeRooms\\.")
if(TARGET test_map_file)
  add_dependencies(test_map_file textslam-map)
  set_source_files_properties(map_file/program_test.cpp PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON SKIP_PRECOMPILE_HEADERS ON
    COMPILE_DEFINITIONS "TEXTSLAM_MAP_PROGRAM=\"$<TARGET_FILE:textslam-map>\"")
endif()

textplane_add_tests(city LIBRARIES textplane_city)

add_test(NAME examples.rooms COMMAND ${CMAKE_COMMAND} -DFOLDER=${PROJECT_SOURCE_DIR}/examples/textslam
  -P ${CMAKE_CURRENT_SOURCE_DIR}/textslam/rooms.cmake)
textplane_label(examples.rooms textslam)

# The node of docs/ros2.md compiles as it stands, against stand-ins for ROS.
if(TEXTPLANE_WARNINGS_AS_ERRORS AND NOT TEXTPLANE_TEST_TIER)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/docs/ros2.md)
  file(READ ${PROJECT_SOURCE_DIR}/docs/ros2.md page)
  if(NOT page MATCHES "```cpp\n([^`]*)```")
    message(FATAL_ERROR "docs/ros2.md has no C++ code")
  endif()
  set(page_code "${CMAKE_MATCH_1}")
  file(CONFIGURE OUTPUT ros2_page.cpp CONTENT "@page_code@" @ONLY)
  add_executable(ros2_page ${CMAKE_CURRENT_BINARY_DIR}/ros2_page.cpp)
  target_include_directories(ros2_page PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/ros2)
  target_link_libraries(ros2_page PRIVATE textplane_plugins)
  target_compile_options(ros2_page PRIVATE $<$<CXX_COMPILER_ID:GNU,Clang,AppleClang>:-O0 -g0>)
endif()

# Tests that start a program, one executable a file. The tests of a file share one rendered sequence, so they are one test for ctest.
# textplane_add_program_test(NAME [TIER...])
function(textplane_add_program_test name)
  textplane_in_tier(wanted ${ARGN})
  if(NOT wanted)
    return()
  endif()
  add_executable(${name} programs/${name}.cpp)
  target_link_libraries(${name} PRIVATE textplane_textslam GTest::gtest GTest::gtest_main)
  target_include_directories(${name} PRIVATE ${CMAKE_CURRENT_SOURCE_DIR})
  target_compile_options(${name} PRIVATE ${unoptimised})  # they start programs and read what those write
  target_precompile_headers(${name} REUSE_FROM textplane_test_unoptimised)
  target_compile_definitions(${name} PRIVATE TEXTSLAM_PROGRAM="$<TARGET_FILE:textslam>"
    TEXTSLAM_EVAL_PROGRAM="$<TARGET_FILE:textslam-eval>" TEXTSLAM_MAP_PROGRAM="$<TARGET_FILE:textslam-map>")
  add_dependencies(${name} textslam textslam-eval textslam-map)
  add_test(NAME examples.${name} COMMAND ${name})
  set_tests_properties(examples.${name} PROPERTIES TIMEOUT 1200 COST 20)  # ctest begins with what costs most
  textplane_label(examples.${name} programs ${ARGN})
endfunction()
textplane_add_program_test(textslam_eval_test ${sanitizers})
textplane_add_program_test(textslam_input_test ${sanitizers})
textplane_add_program_test(textslam_loop_test)
textplane_add_program_test(textslam_messages_test ${sanitizers})
textplane_add_program_test(textslam_outputs_test)
textplane_add_program_test(textslam_recovery_test)
textplane_add_program_test(textslam_report_test)
textplane_add_program_test(textslam_run_test)
textplane_add_program_test(textslam_sessions_test)
if(TARGET textslam_sessions_test)
  target_link_libraries(textslam_sessions_test PRIVATE textplane_textslam_map)
endif()
textplane_add_program_test(textslam_unusual_input_test ${sanitizers})
textplane_add_program_test(textslam_calibrate_test)

# The numbered examples: each runs, and a number that it prints is checked.
function(textplane_test_example name text bound)
  if(TARGET ${name})
    add_test(NAME examples.${name} COMMAND ${CMAKE_COMMAND} -DPROGRAM=$<TARGET_FILE:${name}> "-DTEXT=${text}" -D${bound}
      -P ${CMAKE_CURRENT_SOURCE_DIR}/programs/numbered.cmake)
    textplane_label(examples.${name} programs)
  endif()
endfunction()
textplane_test_example(01_warp_a_sign "zncc" ABOVE=0.99)
textplane_test_example(02_theta_from_three_corners "normal off by" BELOW=1)
textplane_test_example(03_align_one_patch "aligned: corners off by" BELOW=0.05)
textplane_test_example(04_refine_theta "refined: normal off by" BELOW=0.6)
textplane_test_example(05_track_a_plane "worst of 30 frames: corners off by" BELOW=0.15)
textplane_test_example(06_relight "worst: corners off by" BELOW=0.3)
textplane_test_example(07_ceres_bundle_adjustment "after: positions off by" BELOW=6)
textplane_test_example(08_many_candidates "refined: corners off by" BELOW=0.1)

# The sequence of the examples that read one: rendering it takes longer than all of them. The trackers need the most frames.
set(rendered ${CMAKE_CURRENT_BINARY_DIR}/rendered)
add_test(NAME examples.sequence COMMAND textslam --render rapid --frames $<IF:$<TARGET_EXISTS:foreign_tracker>,90,50> --render-only --output ${rendered})
set_tests_properties(examples.sequence PROPERTIES FIXTURES_SETUP rendered COST 20)
textplane_label(examples.sequence programs)
add_test(NAME examples.own_detector COMMAND ${CMAKE_COMMAND} "-DPROGRAM=$<TARGET_FILE:own_detector>;${rendered}/sequence;${rendered}/own_detector"
  "-DTEXT=texts mapped:" -DABOVE=0 -P ${CMAKE_CURRENT_SOURCE_DIR}/programs/numbered.cmake)
set_tests_properties(examples.own_detector PROPERTIES FIXTURES_REQUIRED rendered)
textplane_label(examples.own_detector programs)
if(TARGET foreign_tracker)
  add_test(NAME examples.foreign_tracker COMMAND ${CMAKE_COMMAND} -DPROGRAM=$<TARGET_FILE:foreign_tracker> -DSEQUENCE=${rendered}/sequence
    -DOUTPUT=${rendered}/foreign_tracker -DFOLDER=${PROJECT_SOURCE_DIR}/examples/foreign_tracker -P ${CMAKE_CURRENT_SOURCE_DIR}/programs/foreign_tracker.cmake)
  set_tests_properties(examples.foreign_tracker PROPERTIES FIXTURES_REQUIRED rendered TIMEOUT 1200)
  textplane_label(examples.foreign_tracker programs)
  add_test(NAME examples.odometry COMMAND ${CMAKE_COMMAND} -DPROGRAMS=$<TARGET_FILE_DIR:frame_to_map> -DSEQUENCE=${rendered}/sequence
    -DOUTPUT=${rendered}/odometry -DFOLDER=${PROJECT_SOURCE_DIR}/examples/odometry -P ${CMAKE_CURRENT_SOURCE_DIR}/programs/odometry.cmake)
  set_tests_properties(examples.odometry PROPERTIES FIXTURES_REQUIRED rendered TIMEOUT 1200)
  textplane_label(examples.odometry programs)
endif()

# Two tests leave their reports for that in a browser.
if(TARGET textslam_report_test)
  set(reports ${CMAKE_CURRENT_BINARY_DIR}/reports)
  foreach(made textslam_report_test textslam_sessions_test)
    target_compile_definitions(${made} PRIVATE TEXTSLAM_REPORTS="${reports}")
    set_tests_properties(examples.${made} PROPERTIES FIXTURES_SETUP reports)
  endforeach()
endif()

# The script of the experiments, with a stand-in for textslam; readers of other libraries on textslam's outputs; and in
# --all the reports in a browser, where there is one.
find_package(Python3 3.9 QUIET COMPONENTS Interpreter)
if(NOT Python3_FOUND)
  return()
endif()
set(programs ${CMAKE_CURRENT_SOURCE_DIR}/programs)
add_test(NAME examples.experiments COMMAND ${Python3_EXECUTABLE} ${programs}/experiments_test.py ${PROJECT_SOURCE_DIR})
textplane_label(examples.experiments programs)
add_test(NAME examples.sessions_experiments
         COMMAND ${Python3_EXECUTABLE} ${programs}/sessions_experiments_test.py ${PROJECT_SOURCE_DIR})
textplane_label(examples.sessions_experiments programs)
add_test(NAME examples.foreign_readers COMMAND ${Python3_EXECUTABLE} ${programs}/foreign_readers_test.py $<TARGET_FILE:textslam>)
set_tests_properties(examples.foreign_readers PROPERTIES SKIP_RETURN_CODE 77)
textplane_label(examples.foreign_readers programs)
add_test(NAME examples.viewers COMMAND ${Python3_EXECUTABLE} ${programs}/viewers_test.py ${PROJECT_SOURCE_DIR} $<TARGET_FILE:textslam>
  ${rendered}/sequence)
set_tests_properties(examples.viewers PROPERTIES FIXTURES_REQUIRED rendered)
textplane_label(examples.viewers programs)
if(TARGET textslam_report_test AND TEXTPLANE_TEST_LONG)
  add_test(NAME examples.report_browser COMMAND ${Python3_EXECUTABLE} ${programs}/report_browser_test.py ${reports})
  set_tests_properties(examples.report_browser PROPERTIES FIXTURES_REQUIRED reports SKIP_RETURN_CODE 77 TIMEOUT 1200)
  textplane_label(examples.report_browser programs)
endif()
