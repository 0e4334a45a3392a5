#include "io/detections.hpp"

#include <algorithm>
#include <filesystem>

#include "io/input_error.hpp"
#include "io/output_file.hpp"
#include "io/text_file.hpp"

namespace textslam {

namespace fs = std::filesystem;

namespace {

// The eight numbers at the front of a line; `rest` receives what follows the eighth comma, if there is one.
Quad<double> parse_quad(const TextLine& line, const std::string& path, std::string_view* rest) {
  static const char* const kNames[8] = {"x1", "y1", "x2", "y2", "x3", "y3", "x4", "y4"};
  std::string_view text = line.text;
  double v[8];
  for (int i = 0; i < 8; ++i) {
    const std::size_t comma = text.find(',');
    v[i] = require_number(text.substr(0, comma), path, line.number, kNames[i]);
    const bool last = comma == std::string_view::npos;
    if (last && i < 7) {
      throw InputError(path, line.number, "a box has 8 numbers separated by commas, not " + std::to_string(i + 1));
    }
    text.remove_prefix(last ? text.size() : comma + 1);
  }
  *rest = text;
  Quad<double> quad;
  for (std::size_t i = 0; i < 4; ++i) quad.corner[i] = Vector2<double>(v[2 * i], v[2 * i + 1]);
  return quad;
}

std::string detection_text(std::string_view text) { return text.empty() ? kUnreadText : well_formed_utf8(text); }

Quad<double> distorted(const Quad<double>& quad, const CameraModel& camera) {
  if (camera.lens.is_zero()) return quad;
  Quad<double> raw;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vector2<double> m = camera.pinhole.unproject(quad.corner[i]).head<2>();
    raw.corner[i] = camera.pinhole.pixel(camera.lens.distort(m));
  }
  return raw;
}

std::vector<Detection> read_pair(const std::string& boxes, const std::string& words, const CameraModel& camera) {
  std::vector<Detection> detections;
  for (const TextLine& line : read_lines(boxes)) {
    std::string_view rest;
    Detection detection;
    detection.quad = distorted(parse_quad(line, boxes, &rest), camera);
    if (!trimmed(rest).empty()) throw InputError(boxes, line.number, "a box has 8 numbers and nothing after them");
    detections.push_back(detection);
  }
  std::error_code error;
  if (!fs::exists(words, error)) return detections;
  const std::vector<TextLine> lines = read_lines(words);
  if (lines.size() != detections.size()) {
    throw InputError(
        words, 0,
        std::to_string(lines.size()) + " words for the " + std::to_string(detections.size()) + " boxes of " + boxes);
  }
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::string_view line = lines[i].text;
    const std::size_t comma = line.rfind(',');
    if (comma == std::string_view::npos) throw InputError(words, lines[i].number, "expected 'word,score'");
    detections[i].text = detection_text(line.substr(0, comma));
    detections[i].score = require_number(line.substr(comma + 1), words, lines[i].number, "the score");
  }
  return detections;
}

}  // namespace

std::vector<Detection> read_icdar(const std::string& path) {
  std::vector<Detection> detections;
  for (const TextLine& line : read_lines(path)) {
    std::string_view rest;
    Detection detection;
    detection.quad = parse_quad(line, path, &rest);
    detection.text = detection_text(rest);
    detections.push_back(detection);
  }
  return detections;
}

std::vector<Detection> read_detections(const Sequence& sequence, const FrameRef& frame) {
  const fs::path folder(sequence.folder);
  std::error_code error;
  const fs::path icdar = folder / "detections" / (frame.stem + ".txt");
  if (fs::exists(icdar, error)) return read_icdar(icdar.string());
  for (const char* name : {"detections", "text"}) {
    const fs::path boxes = folder / name / (frame.stem + "_dete.txt");
    const fs::path words = folder / name / (frame.stem + "_mean.txt");
    if (fs::exists(boxes, error)) return read_pair(boxes.string(), words.string(), sequence.camera);
  }
  return {};
}

std::string format_detections(const std::vector<Detection>& detections) {
  std::string out;
  for (const Detection& detection : detections) {
    for (const Vector2<double>& corner : detection.quad.corner) {
      out += shortest(corner[0]) + "," + shortest(corner[1]) + ",";
    }
    std::string text = detection.text.empty() ? kUnreadText : detection.text;
    std::replace_if(
        text.begin(), text.end(), [](char c) { return c == '\n' || c == '\r' || c == '\0'; }, ' ');
    out += text + "\n";
  }
  return out;
}

void write_detections(const std::string& path, const std::vector<Detection>& detections) {
  write_file(path, format_detections(detections));
}

}  // namespace textslam
