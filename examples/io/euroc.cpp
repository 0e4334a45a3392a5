#include "io/euroc.hpp"

#include <charconv>
#include <cmath>
#include <cstdint>
#include <filesystem>

#include "io/input_error.hpp"
#include "io/paths.hpp"
#include "io/text_file.hpp"
#include "textplane/core/numeric.hpp"

namespace textslam {

namespace fs = std::filesystem;

namespace {

std::vector<std::string_view> split_commas(std::string_view text) {
  std::vector<std::string_view> columns;
  for (;;) {
    const std::size_t comma = text.find(',');
    columns.push_back(trimmed(text.substr(0, comma)));
    if (comma == std::string_view::npos) return columns;
    text.remove_prefix(comma + 1);
  }
}

double seconds(std::string_view stamp, const std::string& path, int line) {
  std::int64_t ns = 0;
  const auto [end, error] = std::from_chars(stamp.data(), stamp.data() + stamp.size(), ns);
  if (error != std::errc() || end != stamp.data() + stamp.size())
    throw InputError(path, line, "the timestamp should be a whole number of nanoseconds, not " + shown(stamp));
  return static_cast<double>(ns) / 1e9;
}

[[noreturn]] void refuse_order(const std::string& path, int line, std::string_view stamp) {
  throw InputError(path, line, "times must increase: " + shown(stamp) + " does not follow the line before");
}

}  // namespace

bool find_euroc(const std::string& folder, EurocFiles* files) {
  fs::path mav = fs::path(folder) / "mav0";
  if (!is_folder(mav / "cam0")) mav = folder;
  if (!is_folder(mav / "cam0")) return false;
  files->list = (mav / "cam0" / "data.csv").string();
  files->images = (mav / "cam0" / "data").string();
  files->camera = (mav / "cam0" / "sensor.yaml").string();
  files->truth = (mav / "state_groundtruth_estimate0" / "data.csv").string();
  return true;
}

std::vector<FrameRef> read_euroc_frames(const std::string& list, const std::string& images) {
  std::vector<FrameRef> frames;
  for (const TextLine& line : read_lines(list)) {
    if (trimmed(line.text)[0] == '#') continue;
    const std::vector<std::string_view> columns = split_commas(line.text);
    FrameRef frame;
    frame.line = line.number;
    frame.timestamp = seconds(columns[0], list, line.number);
    if (columns.size() != 2 || columns[1].empty())
      throw InputError(list, line.number, "expected 'timestamp,file name'");
    if (!frames.empty() && !(frame.timestamp > frames.back().timestamp)) refuse_order(list, line.number, columns[0]);
    const fs::path path = fs::path(images) / columns[1];
    frame.path = path.string();
    frame.stem = path.stem().string();
    frames.push_back(std::move(frame));
  }
  if (frames.empty()) throw InputError(list, 0, "the list names no image");
  return frames;
}

std::vector<StampedPose> read_euroc_truth(const std::string& path, const SE3d& T_b_c) {
  static const char* const kColumns[8] = {"timestamp", "x", "y", "z", "qw", "qx", "qy", "qz"};
  std::vector<StampedPose> poses;
  for (const TextLine& line : read_lines(path)) {
    if (trimmed(line.text)[0] == '#') continue;
    const std::vector<std::string_view> columns = split_commas(line.text);
    if (columns.size() < 8) {
      throw InputError(path, line.number,
                       "a pose has 8 columns (timestamp,x,y,z,qw,qx,qy,qz), not " + std::to_string(columns.size()));
    }
    StampedPose pose;
    pose.timestamp = seconds(columns[0], path, line.number);
    if (!poses.empty() && !(pose.timestamp > poses.back().timestamp)) refuse_order(path, line.number, columns[0]);
    double v[8] = {};
    for (std::size_t i = 1; i < 8; ++i) v[i] = require_number(columns[i], path, line.number, kColumns[i]);
    const Eigen::Quaterniond q(v[4], v[5], v[6], v[7]);
    if (!(std::abs(q.norm() - 1) <= 0.01)) throw InputError(path, line.number, "the quaternion is not of unit length");
    pose.T_w_c = SE3d{q.normalized().toRotationMatrix(), Vector3<double>(v[1], v[2], v[3])} * T_b_c;
    if (!textplane::all_finite(pose.T_w_c)) throw InputError(path, line.number, "the position is out of range");
    poses.push_back(pose);
  }
  return poses;
}

}  // namespace textslam
