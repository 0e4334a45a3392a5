#include "plugins/plugins.hpp"

#include "detectors/classical_detector.hpp"

#ifdef TEXTSLAM_WITH_DNN
#include "detectors/dnn_detector.hpp"
#include "detectors/dnn_reader.hpp"
#endif
#ifdef TEXTSLAM_WITH_TESSERACT
#include "detectors/tesseract_detector.hpp"
#endif
#ifdef TEXTSLAM_WITH_VIDEO
#include "video/libav_video.hpp"
#endif

namespace textslam {

void register_plugins() {
  register_plugin({"classical", [](auto&...) { return std::make_unique<ClassicalDetector>(); }, nullptr});
#ifdef TEXTSLAM_WITH_DNN
  register_plugin({"dnn", make_dnn_detector, make_dnn_reader, is_dnn_reader_ready, {"dnn", "tesseract"}});
#else
  register_plugin(missing_plugin("dnn", "TEXTSLAM_DNN", "libopencv-dev"));
#endif
#ifdef TEXTSLAM_WITH_TESSERACT
  register_plugin(
      {"tesseract", make_tesseract_detector, make_tesseract_reader, is_tesseract_ready, {"tesseract"}, true});
#else
  register_plugin(missing_plugin("tesseract", "TEXTSLAM_TESSERACT", "libtesseract-dev tesseract-ocr-eng"));
#endif
#ifdef TEXTSLAM_WITH_VIDEO
  register_video(open_libav_video);
#endif
}

}  // namespace textslam
