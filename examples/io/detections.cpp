#include "io/detections.hpp"

#include <algorithm>
#include <filesystem>

#include "io/input_error.hpp"
#include "io/output_file.hpp"
#include "io/paths.hpp"
#include "io/text_file.hpp"
#include "textplane/landmarks/icdar.hpp"

namespace textslam {

namespace fs = std::filesystem;

namespace {

// The eight numbers at the front of a line; `rest` receives what follows the eighth comma, if there is one.
Quad<double> parse_quad(const TextLine& line, const std::string& path, std::string_view* rest) {
  static const char* const kNames[8] = {"x1", "y1", "x2", "y2", "x3", "y3", "x4", "y4"};
  double v[8];
  textplane::IcdarFault fault;
  const textplane::Status status = textplane::parse_icdar_numbers(line.text, 8, v, rest, &fault);
  if (status == textplane::Status::too_few) {
    throw InputError(path, line.number, "a box has 8 numbers separated by commas, not " + std::to_string(fault.field));
  }
  if (!textplane::is_ok(status)) throw not_a_number(fault.text, path, line.number, kNames[fault.field]);
  Quad<double> quad;
  for (std::size_t i = 0; i < 4; ++i) quad.corner[i] = Vector2<double>(v[2 * i], v[2 * i + 1]);
  return quad;
}

std::string detection_text(std::string_view text) { return text.empty() ? kUnreadText : well_formed_utf8(text); }

Quad<double> distorted(const Quad<double>& quad, const CameraModel& camera) {
  if (camera.is_pinhole()) return quad;
  Quad<double> raw;
  for (std::size_t i = 0; i < 4; ++i) raw.corner[i] = camera.project(camera.pinhole().unproject(quad.corner[i]));
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
  if (!is_there(words)) return detections;
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

std::vector<fs::path> icdar_files(const fs::path& folder, const std::string& stem) {
  return {folder / (stem + ".txt"), folder / ("res_" + stem + ".txt"), folder / truth_name(stem)};
}

// Without <stem>.txt, which may be anything beside images.
std::vector<fs::path> files_beside(const FrameRef& frame) {
  if (frame.path.empty()) return {};
  std::vector<fs::path> files = icdar_files(fs::path(frame.path).parent_path(), frame.stem);
  files.erase(files.begin());
  return files;
}

std::vector<Detection> read_named(const fs::path& file, const std::string& stem) {
  std::vector<Detection> detections = read_icdar(file.string());
  if (file.filename() != truth_name(stem)) return detections;
  const auto ignored = [](const Detection& detection) { return detection.text == kUnreadText; };
  detections.erase(std::remove_if(detections.begin(), detections.end(), ignored), detections.end());
  return detections;
}

}  // namespace

std::vector<Quad<double>> quads_of(const std::vector<Detection>& detections) {
  std::vector<Quad<double>> quads;
  for (const Detection& detection : detections) quads.push_back(detection.quad);
  return quads;
}

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
  const bool own = sequence.detections.empty();
  if (own && sequence.video) return {};
  const fs::path folder(sequence.folder);
  for (const fs::path& file : icdar_files(own ? folder / "detections" : fs::path(sequence.detections), frame.stem)) {
    if (is_there(file)) return read_named(file, frame.stem);
  }
  if (own) {
    for (const fs::path& file : files_beside(frame)) {
      if (is_there(file)) return read_named(file, frame.stem);
    }
  }
  for (const fs::path& place : own ? std::vector<fs::path>{folder / "detections", folder / "text"}
                                   : std::vector<fs::path>{sequence.detections}) {
    const fs::path boxes = place / (frame.stem + "_dete.txt");
    const fs::path words = place / (frame.stem + "_mean.txt");
    if (is_there(boxes)) return read_pair(boxes.string(), words.string(), sequence.camera);
  }
  return {};
}

bool has_detections(const Sequence& sequence) {
  if (!sequence.detections.empty()) return true;
  if (sequence.video) return false;
  const fs::path folder(sequence.folder);
  if (is_folder(folder / "detections") || is_folder(folder / "text")) return true;
  const std::vector<fs::path> beside = files_beside(sequence.frames.front());
  return std::any_of(beside.begin(), beside.end(), is_there);
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
