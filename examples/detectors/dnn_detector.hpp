// DnnDetector: text quads by a network that OpenCV runs. Its outputs tell its kind:
//
//   DB    one output, the probability map at the size of the input (PP-OCR's detectors; scripts/get-detector gets one)
//   EAST  two outputs at a quarter of it, score and geometry (frozen_east_text_detection.pb)
//
// It reads nothing.
#ifndef TEXTSLAM_DETECTORS_DNN_DETECTOR_HPP
#define TEXTSLAM_DETECTORS_DNN_DETECTOR_HPP

#include <memory>
#include <opencv2/dnn/dnn.hpp>
#include <string>
#include <vector>

#include "detectors/db_boxes.hpp"
#include "detectors/east_boxes.hpp"
#include "detectors/network_input.hpp"
#include "textslam/detect/text_detector.hpp"

namespace textslam {

struct DnnParameters {
  int long_side =
      960;  ///< px of the network's input: the image's longer side; the shorter in proportion, in whole steps.
  DbParameters db;
  EastParameters east;
};

class DnnDetector final : public TextDetector {
 public:
  /// `model`: any file that cv::dnn::readNet() knows. Throws InputError with its name if it is missing, does not load
  /// or run, or has other outputs.
  explicit DnnDetector(const std::string& model, const DnnParameters& parameters = {});

  bool wants_colour() const override { return true; }
  /// Text kUnreadText, score in [0, 1]. The networks use colour: the frame's own, else an image file of this size is
  /// read again in colour. Empty for an invalid view.
  std::vector<Detection> detect(const FrameRef& frame, ImageView8 raw_image) override;

  bool is_east() const { return outputs_.size() == 2; }

 private:
  std::vector<cv::Mat> forward(const cv::Mat& image, const NetworkSize& size);
  std::string reason_it_is_wrong();

  std::string model_;
  DnnParameters parameters_;
  cv::dnn::Net net_;
  cv::Size loaded_for_;               // of the input
  std::vector<std::string> outputs_;  // of EAST the score first
};

/// With `options.model`, or the model that scripts/get-detector makes. Throws as DnnDetector().
std::unique_ptr<TextDetector> make_dnn_detector(const DetectorOptions& options, const Sequence& sequence);

}  // namespace textslam

#endif  // TEXTSLAM_DETECTORS_DNN_DETECTOR_HPP
