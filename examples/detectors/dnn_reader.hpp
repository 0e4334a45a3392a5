// DnnReader: the words of quads by a recogniser that OpenCV runs (line_recogniser.hpp; scripts/get-detector --reader).
// The output is [1, steps, letters]: the blank, the letters of the list beside the model, the space.
#ifndef TEXTSLAM_DETECTORS_DNN_READER_HPP
#define TEXTSLAM_DETECTORS_DNN_READER_HPP

#include <memory>
#include <opencv2/dnn/dnn.hpp>
#include <string>
#include <vector>

#include "detectors/line_recogniser.hpp"

namespace textslam {

class DnnReader final : public TextReader {
 public:
  /// The list of letters, one a line, is `model` with the ending .txt. Throws InputError with the name of a file that
  /// is missing, does not load or run, or does not fit.
  explicit DnnReader(const std::string& model, const RecogniserParameters& parameters = {});

  Reading read(ImageView8 raw_image, const Quad<double>& quad) override;

 private:
  cv::Mat forward(const Image<std::uint8_t>& picture);

  RecogniserParameters parameters_;
  cv::dnn::Net net_;
  std::vector<std::string> letters_;
};

/// With `options.words_model`, or the model that scripts/get-detector --reader makes. Throws as DnnReader().
std::unique_ptr<TextReader> make_dnn_reader(const DetectorOptions& options);
/// Whether a model is named, or that one is there.
bool is_dnn_reader_ready(const DetectorOptions& options);

}  // namespace textslam

#endif  // TEXTSLAM_DETECTORS_DNN_READER_HPP
