// DnnReader: the words of quads by a recogniser that OpenCV runs, a network with CTC's output (PP-OCR's; scripts/get-detector
// --reader obtains one): [1, steps, letters], blank first, then the letters of the list beside the model, then the space.
#ifndef TEXTSLAM_DETECTORS_DNN_READER_HPP
#define TEXTSLAM_DETECTORS_DNN_READER_HPP

#include <opencv2/dnn/dnn.hpp>
#include <string>
#include <vector>

#include "textslam/detect/text_detector.hpp"

namespace textslam {

struct DnnReaderParameters {
  int height = 48;              ///< px of the network's input,
  int width = 320;              ///< longer lines are squeezed into it, shorter ones padded.
  double margin = 0.1;          ///< Of a quad's height, around it.
  double min_confidence = 0.5;  ///< 0 to 1: mean probability of the letters.
};

/// CTC's best path: of each step the likeliest class; what is said again, and the blank (class 0), go. `probability`: steps x
/// classes, row by row. `letters` are classes 1 and on, the last class is the space.
TextReader::Reading decode_ctc(const float* probability, int steps, int classes,
                               const std::vector<std::string>& letters);

class DnnReader final : public TextReader {
 public:
  /// The list of letters, one a line, is `model` with the ending .txt. Throws InputError that names what is missing, does not
  /// load, does not run, or does not fit.
  explicit DnnReader(const std::string& model, const DnnReaderParameters& parameters = {});

  Reading read(ImageView8 raw_image, const Quad<double>& quad) override;

 private:
  cv::Mat forward(const Image<std::uint8_t>& picture);

  DnnReaderParameters parameters_;
  cv::dnn::Net net_;
  std::vector<std::string> letters_;
};

}  // namespace textslam

#endif  // TEXTSLAM_DETECTORS_DNN_READER_HPP
