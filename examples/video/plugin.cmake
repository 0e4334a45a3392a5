# Video files as input need libraries of their own; off by default: the programs say how to build it.
option(TEXTSLAM_VIDEO "Read video files (Debian: libavformat-dev libavcodec-dev libswscale-dev)" OFF)

if(TEXTSLAM_VIDEO)
  find_package(PkgConfig REQUIRED)
  pkg_check_modules(LIBAV REQUIRED IMPORTED_TARGET libavformat libavcodec libswscale libavutil)
  target_sources(textplane_io PRIVATE video/video_file.cpp)
  target_link_libraries(textplane_io PRIVATE PkgConfig::LIBAV)
else()
  target_sources(textplane_io PRIVATE video/no_video.cpp)
endif()
