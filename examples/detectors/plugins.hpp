// The detectors that need libraries of their own: each is built where its CMake option is on, and tells here whether it was.
#ifndef TEXTSLAM_DETECTORS_PLUGINS_HPP
#define TEXTSLAM_DETECTORS_PLUGINS_HPP

#include <memory>
#include <string>

#include "textslam/detect/text_detector.hpp"

namespace textslam {

#ifdef TEXTSLAM_WITH_DNN
constexpr bool kHasDnn = true;
/// See dnn_detector.hpp. Throws InputError where the model is missing or none that it knows.
std::unique_ptr<TextDetector> make_dnn_detector(const std::string& model);
/// See dnn_reader.hpp; an empty name is that of the model which scripts/get-detector --reader makes. Throws InputError likewise.
std::unique_ptr<TextReader> make_dnn_reader(const std::string& model);
/// Whether that one is there.
bool has_default_dnn_reader();
#else
constexpr bool kHasDnn = false;
inline std::unique_ptr<TextDetector> make_dnn_detector(const std::string&) { return nullptr; }
inline std::unique_ptr<TextReader> make_dnn_reader(const std::string&) { return nullptr; }
inline bool has_default_dnn_reader() { return false; }
#endif

#ifdef TEXTSLAM_WITH_TESSERACT
constexpr bool kHasTesseract = true;
/// See tesseract_detector.hpp. Throw InputError where Tesseract has no data for the language.
std::unique_ptr<TextDetector> make_tesseract_detector();
std::unique_ptr<TextReader> make_tesseract_reader();
#else
constexpr bool kHasTesseract = false;
inline std::unique_ptr<TextDetector> make_tesseract_detector() { return nullptr; }
inline std::unique_ptr<TextReader> make_tesseract_reader() { return nullptr; }
#endif

}  // namespace textslam

#endif  // TEXTSLAM_DETECTORS_PLUGINS_HPP
