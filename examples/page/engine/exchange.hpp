// What JavaScript and the module share: memory that both write and read, and answers as JSON.
#ifndef TEXTSLAM_PAGE_EXCHANGE_HPP
#define TEXTSLAM_PAGE_EXCHANGE_HPP

#include <cstdint>
#include <exception>
#include <new>
#include <stdexcept>
#include <string>
#include <vector>

#include "io/detections.hpp"
#include "io/image_codecs.hpp"
#include "textslam/common/report_json.hpp"

namespace textslam {

struct Exchange {
  std::vector<std::uint8_t> pixels;  // of the frame that comes
  std::vector<float> values;         // into and out of a network
  std::string answer;
};

inline Exchange& exchange() {
  static Exchange one;
  return one;
}

/// Red, green, blue and alpha of each of `count` pixels become their grey value, at the same place.
inline void to_grey(int count) {
  std::uint8_t* p = exchange().pixels.data();
  for (int i = 0; i < count; ++i) p[i] = grey_of(p[4 * i], p[4 * i + 1], p[4 * i + 2]);
}

/// The grey image there.
inline ImageView8 grey_view(int width, int height) { return {exchange().pixels.data(), width, height, width}; }

/// The pixels of an image, row by row.
inline std::vector<std::uint8_t> packed(ImageView8 image) {
  if (!image.valid()) throw std::invalid_argument("packed: the view is not valid");
  std::vector<std::uint8_t> pixels;
  pixels.reserve(static_cast<std::size_t>(image.width()) * static_cast<std::size_t>(image.height()));
  for (int y = 0; y < image.height(); ++y) pixels.insert(pixels.end(), image.row(y), image.row(y) + image.width());
  return pixels;
}

/// What `call` returns, as a string that is good until the next answer; {"error": "..."} where it threw, so that no
/// exception leaves the module.
template <class Call>
const char* answer(Call call) {
  Json out;
  try {
    out = call();
  } catch (const std::bad_alloc&) {
    out = {{"error", "the browser gives the page no more memory"}};
  } catch (const std::exception& error) {
    out = {{"error", error.what()}};
  }
  exchange().answer = out.dump(-1, ' ', false, Json::error_handler_t::replace);
  return exchange().answer.c_str();
}

/// A quad's eight coordinates, clockwise from the text's top left.
inline Json quad_json(const Quad<double>& quad) {
  Json out = Json::array();
  for (const auto& corner : quad.corner)
    for (const double value : {corner.x(), corner.y()}) out.push_back(value);
  return out;
}

/// Each quad as such a line, and its score.
inline Json quads_json(const std::vector<Detection>& detections) {
  Json out = Json::array();
  for (const Detection& detection : detections) {
    Json one = quad_json(detection.quad);
    one.push_back(detection.score);
    out.push_back(std::move(one));
  }
  return out;
}

/// The quad of such a line.
inline Quad<double> quad_of(const Json& line) {
  Quad<double> quad;
  for (std::size_t i = 0; i < 4; ++i) quad.corner[i] = {line.at(2 * i).get<double>(), line.at(2 * i + 1).get<double>()};
  return quad;
}

}  // namespace textslam

#endif  // TEXTSLAM_PAGE_EXCHANGE_HPP
