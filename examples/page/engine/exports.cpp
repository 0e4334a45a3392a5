// What JavaScript calls. A function returns JSON, which is good until the next call; {"error": "..."} where it failed,
// so that no exception leaves the module. One run at a time; detect() needs none.
#include <emscripten/emscripten.h>

#include <memory>
#include <string>

#include "detectors/classical_detector.hpp"
#include "io/clock.hpp"
#include "io/image_codecs.hpp"
#include "page_run.hpp"

// clang-format off
EM_JS(void, page_progress, (int done, int total), { self.calibrating(done, total); })
// clang-format on

namespace textslam {
namespace {

struct Module {
  std::unique_ptr<PageRun> run;
  ClassicalDetector detector;
  std::vector<std::uint8_t> pixels;  // of the frame that comes, written by JavaScript
  std::string answer;
};

Module& module() {
  static Module one;
  return one;
}

template <class Call>
const char* answer(Call call) {
  Module& m = module();
  Json out;
  try {
    out = call(m);
  } catch (const std::bad_alloc&) {
    out = {{"error", "the browser gives the page no more memory"}};
  } catch (const std::exception& error) {
    out = {{"error", error.what()}};
  }
  m.answer = out.dump(-1, ' ', false, Json::error_handler_t::replace);
  return m.answer.c_str();
}

ImageView8 view(Module& m, int width, int height) { return {m.pixels.data(), width, height, width}; }

Json quads_json(const std::vector<Detection>& detections) {
  Json out = Json::array();
  for (const Detection& detection : detections) {
    Json one = Json::array();
    for (const auto& corner : detection.quad.corner)
      for (const double value : {corner.x(), corner.y()}) one.push_back(value);
    one.push_back(detection.score);
    out.push_back(std::move(one));
  }
  return out;
}

std::vector<Detection> from_json(const std::string& text) {
  std::vector<Detection> out;
  for (const Json& one : Json::parse(text)) {
    Detection detection;
    for (std::size_t i = 0; i < 4; ++i)
      detection.quad.corner[i] = {one.at(2 * i).get<double>(), one.at(2 * i + 1).get<double>()};
    detection.score = one.at(8).get<double>();
    out.push_back(std::move(detection));
  }
  return out;
}

}  // namespace
}  // namespace textslam

using namespace textslam;

extern "C" {

/// Room for so many bytes of pixels, for page_frame(), page_detect() and page_grey().
EMSCRIPTEN_KEEPALIVE std::uint8_t* page_pixels(int bytes) {
  module().pixels.resize(static_cast<std::size_t>(bytes));
  return module().pixels.data();
}

/// Red, green, blue and alpha of each of `count` pixels there become their grey value, at the same place.
EMSCRIPTEN_KEEPALIVE void page_grey(int count) {
  std::uint8_t* p = module().pixels.data();
  for (int i = 0; i < count; ++i) p[i] = grey_of(p[4 * i], p[4 * i + 1], p[4 * i + 2]);
}

EMSCRIPTEN_KEEPALIVE const char* page_open(const char* folder, const char* video) {
  return answer([&](Module& m) {
    m.run = std::make_unique<PageRun>(folder, video);
    return m.run->sequence();
  });
}

EMSCRIPTEN_KEEPALIVE const char* page_keep(double time, int width, int height) {
  return answer([&](Module& m) {
    m.run->keep(time, view(m, width, height));
    return Json::object();
  });
}

EMSCRIPTEN_KEEPALIVE const char* page_calibrate(double fov) {
  return answer([&](Module& m) {
    return m.run->calibrate(fov, [](std::size_t done, std::size_t total) {
      page_progress(static_cast<int>(done), static_cast<int>(total));
    });
  });
}

EMSCRIPTEN_KEEPALIVE const char* page_begin(int width, int height, double fov) {
  return answer([&](Module& m) {
    m.run->begin(width, height, fov, "classical");
    return Json::object();
  });
}

EMSCRIPTEN_KEEPALIVE const char* page_frame(double time, int width, int height) {
  return answer([&](Module& m) { return m.run->frame(time, view(m, width, height)); });
}

EMSCRIPTEN_KEEPALIVE const char* page_detect(int width, int height) {
  return answer([&](Module& m) {
    const double start = now_ms();
    const std::vector<Detection> found = m.detector.detect({}, view(m, width, height));
    return Json{{"quads", quads_json(found)}, {"ms", now_ms() - start}};
  });
}

EMSCRIPTEN_KEEPALIVE const char* page_add_detections(int frame, const char* quads, double ms) {
  return answer([&](Module& m) {
    m.run->add_detections(frame, from_json(quads), ms);
    return Json::object();
  });
}

EMSCRIPTEN_KEEPALIVE const char* page_map() {
  return answer([](Module& m) { return m.run->map(); });
}

EMSCRIPTEN_KEEPALIVE const char* page_finish(const char* folder) {
  return answer([&](Module& m) { return m.run->finish(folder); });
}
}
