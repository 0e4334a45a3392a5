// What JavaScript calls of the system and the built-in detector; network.cpp has what a network's worker calls. A
// function returns JSON as answer() does. One run at a time; detect() needs none.
#include <emscripten/emscripten.h>

#include <memory>
#include <string>

#include "detectors/classical_detector.hpp"
#include "exchange.hpp"
#include "io/clock.hpp"
#include "page_run.hpp"

// clang-format off
EM_JS(void, page_progress, (int done, int total), { self.calibrating(done, total); })
// clang-format on

namespace textslam {
namespace {

struct Module {
  std::unique_ptr<PageRun> run;
  ClassicalDetector detector;
};

Module& module() {
  static Module one;
  return one;
}

std::vector<Detection> from_json(const std::string& text) {
  std::vector<Detection> out;
  for (const Json& one : Json::parse(text)) {
    Detection detection;
    detection.quad = quad_of(one);
    detection.score = one.at(8).get<double>();
    if (one.size() > 9) detection.text = one.at(9).get<std::string>();
    out.push_back(std::move(detection));
  }
  return out;
}

}  // namespace
}  // namespace textslam

using namespace textslam;

extern "C" {

/// Room for so many bytes of pixels, for page_frame(), page_detect(), page_grey() and page_network_image().
EMSCRIPTEN_KEEPALIVE std::uint8_t* page_pixels(int bytes) {
  exchange().pixels.resize(static_cast<std::size_t>(bytes));
  return exchange().pixels.data();
}

/// Red, green, blue and alpha of each of `count` pixels there become their grey value, at the same place.
EMSCRIPTEN_KEEPALIVE void page_grey(int count) { to_grey(count); }

EMSCRIPTEN_KEEPALIVE const char* page_open(const char* folder, const char* video, const char* map) {
  return answer([&] {
    module().run = std::make_unique<PageRun>(folder, video, map);
    return module().run->sequence();
  });
}

EMSCRIPTEN_KEEPALIVE const char* page_keep(double time, int width, int height) {
  return answer([&] {
    module().run->keep(time, grey_view(width, height));
    return Json::object();
  });
}

EMSCRIPTEN_KEEPALIVE const char* page_calibrate(double fov) {
  return answer([&] {
    return module().run->calibrate(fov, [](std::size_t done, std::size_t total) {
      page_progress(static_cast<int>(done), static_cast<int>(total));
    });
  });
}

EMSCRIPTEN_KEEPALIVE const char* page_begin(int width, int height, double fov, const char* detector, int localise) {
  return answer([&] {
    module().run->begin(width, height, fov, detector, localise != 0);
    return Json::object();
  });
}

EMSCRIPTEN_KEEPALIVE const char* page_frame(double time, int width, int height) {
  return answer([&] { return module().run->frame(time, grey_view(width, height)); });
}

EMSCRIPTEN_KEEPALIVE const char* page_detect(int width, int height) {
  return answer([&] {
    const double start = now_ms();
    const std::vector<Detection> found = module().detector.detect({}, grey_view(width, height));
    return Json{{"quads", quads_json(found)}, {"ms", now_ms() - start}};
  });
}

EMSCRIPTEN_KEEPALIVE const char* page_add_detections(int frame, const char* quads, double ms) {
  return answer([&] {
    module().run->add_detections(frame, from_json(quads), ms);
    return Json::object();
  });
}

EMSCRIPTEN_KEEPALIVE const char* page_map() {
  return answer([] { return module().run->map(); });
}

/// Ends the run; how many pictures of texts there are to read.
EMSCRIPTEN_KEEPALIVE const char* page_unread() {
  return answer([] { return Json{{"pictures", module().run->unread()}}; });
}

/// One of them, grey in page_pixels().
EMSCRIPTEN_KEEPALIVE const char* page_picture(int index) {
  return answer([&] {
    const TextPicture& picture = module().run->picture(static_cast<std::size_t>(index));
    const ImageView8 view = picture.image.view();
    exchange().pixels = packed(view);
    return Json{{"width", view.width()}, {"height", view.height()}, {"quad", quad_json(picture.quad)}};
  });
}

/// What was read in them, in their order.
EMSCRIPTEN_KEEPALIVE const char* page_read(const char* readings) {
  return answer([&] {
    std::vector<TextReader::Reading> all;
    for (const Json& one : Json::parse(readings)) {
      TextReader::Reading reading;
      if (const std::string text = one.at("text").get<std::string>(); !text.empty())
        reading = {text, one.at("score").get<double>()};
      all.push_back(reading);
    }
    module().run->take_readings(all);
    return Json::object();
  });
}

EMSCRIPTEN_KEEPALIVE const char* page_finish(const char* folder) {
  return answer([&] { return module().run->finish(folder); });
}
}
