# Detectors that need libraries of their own, each with an option, off by default: the program says how to build what it lacks.
option(TEXTSLAM_DNN "Build the detector `dnn`: networks through OpenCV (Debian: libopencv-dev)" OFF)
option(TEXTSLAM_TESSERACT "Build the detector `tesseract` (Debian: libtesseract-dev tesseract-ocr-eng)" OFF)

if(TEXTSLAM_DNN)
  find_package(OpenCV REQUIRED COMPONENTS core imgproc imgcodecs dnn)
  target_sources(textplane_textslam PRIVATE detectors/db_boxes.cpp detectors/dnn_detector.cpp
    detectors/dnn_reader.cpp)
  target_link_libraries(textplane_textslam PUBLIC opencv_core opencv_imgproc opencv_imgcodecs opencv_dnn)
  target_compile_definitions(textplane_textslam PUBLIC TEXTSLAM_WITH_DNN
    PRIVATE TEXTSLAM_DEFAULT_MODEL="${PROJECT_SOURCE_DIR}/models/ppocrv4_det.onnx"
      TEXTSLAM_DEFAULT_READER="${PROJECT_SOURCE_DIR}/models/ppocrv4_rec.onnx")
endif()

if(TEXTSLAM_TESSERACT)
  find_package(PkgConfig REQUIRED)
  pkg_check_modules(TESSERACT REQUIRED IMPORTED_TARGET tesseract)
  target_sources(textplane_textslam PRIVATE detectors/tesseract_detector.cpp)
  target_link_libraries(textplane_textslam PUBLIC PkgConfig::TESSERACT ${CMAKE_DL_LIBS})
  target_compile_definitions(textplane_textslam PUBLIC TEXTSLAM_WITH_TESSERACT)
endif()
