#include "detectors/line_recogniser.hpp"

#include <algorithm>
#include <cmath>

#include "detectors/line_picture.hpp"

namespace textslam {

Image<std::uint8_t> recogniser_picture(ImageView8 raw_image, const Quad<double>& quad,
                                       const RecogniserParameters& parameters) {
  const double inner = parameters.height / (1 + 2 * parameters.margin);
  const double longest = parameters.width / inner - 2 * parameters.margin;
  return line_picture(raw_image, quad, static_cast<int>(std::lround(inner)), parameters.margin, longest);
}

void recogniser_input(const Image<std::uint8_t>& picture, int width, int height, float* out) {
  const std::ptrdiff_t plane = static_cast<std::ptrdiff_t>(width) * height;
  std::fill_n(out, 3 * plane, 0.0F);
  for (int y = 0; y < std::min(height, picture.height()); ++y)
    for (int x = 0; x < std::min(width, picture.width()); ++x)
      for (int c = 0; c < 3; ++c)
        out[c * plane + static_cast<std::ptrdiff_t>(y) * width + x] = static_cast<float>(picture(x, y)) / 127.5F - 1;
}

TextReader::Reading decode_ctc(const float* probability, int steps, int classes,
                               const std::vector<std::string>& letters) {
  TextReader::Reading reading;
  reading.text.clear();
  int said = 0, count = 0;
  for (int step = 0; step < steps; ++step) {
    const float* row = probability + static_cast<std::ptrdiff_t>(step) * classes;
    const int best = static_cast<int>(std::max_element(row, row + classes) - row);
    if (best != 0 && best != said) {
      reading.text += best == classes - 1 ? " " : letters[static_cast<std::size_t>(best - 1)];
      reading.score += static_cast<double>(row[best]);
      ++count;
    }
    said = best;
  }
  if (count > 0) reading.score /= count;
  return reading;
}

TextReader::Reading read_word(const float* probability, int steps, int classes, const std::vector<std::string>& letters,
                              const RecogniserParameters& parameters) {
  TextReader::Reading reading = decode_ctc(probability, steps, classes, letters);
  reading.text = word_of(reading.text);
  if (reading.text.empty() || reading.score < parameters.min_confidence) return {};
  return reading;
}

}  // namespace textslam
