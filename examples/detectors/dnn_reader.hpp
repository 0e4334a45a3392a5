// DnnReader: the words of quads by a recogniser that OpenCV runs: a network with CTC output, such as PP-OCR's
// (scripts/get-detector --reader). The output is [1, steps, letters]: the blank, the letters of the list beside the
// model, the space.
#ifndef TEXTSLAM_DETECTORS_DNN_READER_HPP
#define TEXTSLAM_DETECTORS_DNN_READER_HPP

#include <memory>
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

/// CTC's best path: the likeliest class of each step, without repetitions and blanks (class 0). `probability`: steps x
/// classes, row by row. `letters` are the classes from 1 on; the last class is the space.
TextReader::Reading decode_ctc(const float* probability, int steps, int classes,
                               const std::vector<std::string>& letters);

class DnnReader final : public TextReader {
 public:
  /// The list of letters, one a line, is `model` with the ending .txt. Throws InputError with the name of a file that
  /// is missing, does not load or run, or does not fit.
  explicit DnnReader(const std::string& model, const DnnReaderParameters& parameters = {});

  Reading read(ImageView8 raw_image, const Quad<double>& quad) override;

 private:
  cv::Mat forward(const Image<std::uint8_t>& picture);

  DnnReaderParameters parameters_;
  cv::dnn::Net net_;
  std::vector<std::string> letters_;
};

/// With `options.words_model`, or the model that scripts/get-detector --reader makes. Throws as DnnReader().
std::unique_ptr<TextReader> make_dnn_reader(const DetectorOptions& options);
/// Whether a model is named, or that one is there.
bool is_dnn_reader_ready(const DetectorOptions& options);

}  // namespace textslam

#endif  // TEXTSLAM_DETECTORS_DNN_READER_HPP
