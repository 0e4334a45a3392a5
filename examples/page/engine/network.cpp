// What the worker of a network calls: the network's inputs, and what its outputs mean. JavaScript runs the network.
#include <emscripten/emscripten.h>

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include "detectors/db_boxes.hpp"
#include "detectors/line_recogniser.hpp"
#include "detectors/network_input.hpp"
#include "exchange.hpp"

namespace textslam {
namespace {

constexpr int kLineStep = 32;  // px: a recogniser takes lines of any width, but for each width anew its time

/// The image that the network looks at, grey in page_pixels().
struct Looked {
  int width = 0, height = 0;
  NetworkSize size{};
  std::vector<std::string> letters;
};

Looked& looked() {
  static Looked one;
  return one;
}

}  // namespace
}  // namespace textslam

using namespace textslam;

extern "C" {

/// Room for so many values of a network; the functions here leave inputs there, and find outputs.
EMSCRIPTEN_KEEPALIVE float* page_network_values(int count) {
  exchange().values.resize(static_cast<std::size_t>(count));
  return exchange().values.data();
}

/// The letters that the recogniser knows, one a line.
EMSCRIPTEN_KEEPALIVE const char* page_network_letters(const char* text) {
  return answer([&] {
    std::istringstream lines(text);
    looked().letters.clear();
    for (std::string line; std::getline(lines, line);) looked().letters.push_back(line);
    return Json{{"letters", looked().letters.size()}};
  });
}

/// Of the image in page_pixels(), red, green, blue and alpha, the input of the detector. It becomes grey there.
EMSCRIPTEN_KEEPALIVE const char* page_network_image(int width, int height, int long_side) {
  return answer([&] {
    Looked& l = looked();
    l.width = width;
    l.height = height;
    l.size = network_size(width, height, long_side);
    page_network_values(3 * l.size.width * l.size.height);
    network_input({exchange().pixels.data(), width, height, 4, true}, kDbColours, l.size, exchange().values.data());
    to_grey(width * height);
    return Json{{"width", l.size.width}, {"height", l.size.height}};
  });
}

/// The quads of the detector's map in that image.
EMSCRIPTEN_KEEPALIVE const char* page_network_boxes() {
  return answer([&]() -> Json {
    const Looked& l = looked();
    if (exchange().values.size() != static_cast<std::size_t>(l.size.width) * static_cast<std::size_t>(l.size.height))
      return {{"error", "detector.js: its detector's map has not the size of its input"}};
    std::vector<Detection> found = decode_db({l.size.height, l.size.width, exchange().values.data()}, DbParameters());
    for (Detection& detection : found) to_image(l.size, l.width, l.height, &detection.quad);
    return {{"quads", quads_json(found)}};
  });
}

/// Another image is looked at: grey, in page_pixels().
EMSCRIPTEN_KEEPALIVE const char* page_network_picture(int width, int height) {
  return answer([&] {
    looked().width = width;
    looked().height = height;
    return Json::object();
  });
}

/// Of a quad there, the input of the recogniser; a width of 0 where it is too small.
EMSCRIPTEN_KEEPALIVE const char* page_network_line(const char* quad) {
  return answer([&] {
    const RecogniserParameters parameters;
    const Image<std::uint8_t> picture =
        recogniser_picture(grey_view(looked().width, looked().height), quad_of(Json::parse(quad)), parameters);
    const int width = std::min(parameters.width, (picture.width() + kLineStep - 1) / kLineStep * kLineStep);
    page_network_values(3 * width * parameters.height);
    recogniser_input(picture, width, parameters.height, exchange().values.data());
    return Json{{"width", width}, {"height", parameters.height}};
  });
}

/// The word in the recogniser's output, "" where it is not sure.
EMSCRIPTEN_KEEPALIVE const char* page_network_word(int steps, int classes) {
  return answer([&]() -> Json {
    if (static_cast<std::size_t>(classes) != looked().letters.size() + 2)
      return {{"error", "detector.js: its letters are not those of its recogniser"}};
    const TextReader::Reading reading =
        read_word(exchange().values.data(), steps, classes, looked().letters, RecogniserParameters());
    return {{"text", is_read(reading.text) ? reading.text : ""}, {"score", reading.score}};
  });
}
}
