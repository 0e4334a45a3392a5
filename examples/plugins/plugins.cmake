# A plug-in that needs a library has an option, off by default; a program names the option of what it lacks.
option(TEXTSLAM_DNN "Build the detector and reader `dnn`: networks through OpenCV (Debian: libopencv-dev)" OFF)
option(TEXTSLAM_TESSERACT "Build the detector and reader `tesseract` (Debian: libtesseract-dev tesseract-ocr-eng)" OFF)
option(TEXTSLAM_VIDEO "Read video files (Debian: libavformat-dev libavcodec-dev libswscale-dev)" OFF)

textplane_add_example_library(plugins textplane_textslam)
# Those of detectors/ that need no library; the others follow.
file(GLOB detectors CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/detectors/*.cpp)
list(FILTER detectors EXCLUDE REGEX "/(dnn|tesseract)_[a-z]+\\.cpp$")
target_sources(textplane_plugins PRIVATE ${detectors})
if(TEXTSLAM_DNN)
  find_package(OpenCV REQUIRED COMPONENTS core imgproc imgcodecs dnn)
  target_sources(textplane_plugins PRIVATE detectors/dnn_detector.cpp detectors/dnn_reader.cpp)
  target_link_libraries(textplane_plugins PUBLIC opencv_core opencv_imgproc opencv_imgcodecs opencv_dnn)
  target_compile_definitions(textplane_plugins PUBLIC TEXTSLAM_WITH_DNN
    PRIVATE TEXTSLAM_DEFAULT_MODEL="${PROJECT_SOURCE_DIR}/models/ppocrv4_det.onnx"
      TEXTSLAM_DEFAULT_READER="${PROJECT_SOURCE_DIR}/models/ppocrv4_rec.onnx")
endif()

if(TEXTSLAM_TESSERACT OR TEXTSLAM_VIDEO)
  find_package(PkgConfig REQUIRED)
endif()
if(TEXTSLAM_TESSERACT)
  pkg_check_modules(TESSERACT REQUIRED IMPORTED_TARGET tesseract)
  target_sources(textplane_plugins PRIVATE detectors/tesseract_detector.cpp)
  target_link_libraries(textplane_plugins PUBLIC PkgConfig::TESSERACT ${CMAKE_DL_LIBS})
  target_compile_definitions(textplane_plugins PUBLIC TEXTSLAM_WITH_TESSERACT)
endif()

if(TEXTSLAM_VIDEO)
  pkg_check_modules(LIBAV REQUIRED IMPORTED_TARGET libavformat libavcodec libswscale libavutil)
  target_sources(textplane_plugins PRIVATE video/libav_video.cpp)
  target_link_libraries(textplane_plugins PRIVATE PkgConfig::LIBAV)
  target_compile_definitions(textplane_plugins PUBLIC TEXTSLAM_WITH_VIDEO)
endif()
