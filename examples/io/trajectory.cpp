#include "io/trajectory.hpp"

#include <charconv>
#include <cmath>
#include <stdexcept>

#include "io/input_error.hpp"
#include "io/output_file.hpp"
#include "io/text_file.hpp"

namespace textslam {

namespace {

void append_fixed(std::string* out, double value, int decimals) {
  if (std::abs(value) < 0.5 * std::pow(10.0, -decimals)) value = 0;  // no "-0.000"
  char text[400];  // the largest double has 309 digits before the point
  const auto result = std::to_chars(text, text + sizeof text, value, std::chars_format::fixed, decimals);
  out->append(text, result.ptr);
}

}  // namespace

std::vector<StampedPose> read_tum(const std::string& path) {
  static const char* const kColumns[8] = {"timestamp", "tx", "ty", "tz", "qx", "qy", "qz", "qw"};
  std::vector<StampedPose> poses;
  for (const TextLine& line : read_lines(path)) {
    const std::vector<std::string_view> words = split_blanks(line.text);
    if (words.front().front() == '#') continue;
    if (words.size() != 8) {
      throw InputError(path, line.number,
                       "a pose has 8 columns (timestamp tx ty tz qx qy qz qw), not " + std::to_string(words.size()));
    }
    double v[8];
    for (int i = 0; i < 8; ++i)
      v[i] = require_number(words[static_cast<std::size_t>(i)], path, line.number, kColumns[i]);
    if (!poses.empty() && !(v[0] > poses.back().timestamp)) {
      throw InputError(path, line.number,
                       "times must increase: " + shown(words[0]) + " does not follow the pose before");
    }
    const Eigen::Quaterniond q(v[7], v[4], v[5], v[6]);
    const double norm = q.norm();
    if (!(std::abs(norm - 1) <= 0.01)) throw InputError(path, line.number, "the quaternion is not of unit length");
    StampedPose pose;
    pose.timestamp = v[0];
    pose.T_w_c = {q.normalized().toRotationMatrix(), Vector3<double>(v[1], v[2], v[3])};
    poses.push_back(pose);
  }
  return poses;
}

std::string format_tum(const std::vector<StampedPose>& poses) {
  std::string out = "# timestamp tx ty tz qx qy qz qw (camera to world)\n";
  for (const StampedPose& pose : poses) {
    if (!textplane::is_finite(pose.timestamp) || !textplane::all_finite(pose.T_w_c)) {
      throw std::invalid_argument("format_tum: a pose is not finite");
    }
    Eigen::Quaterniond q(pose.T_w_c.R);
    q.normalize();
    if (q.w() < 0) q.coeffs() *= -1;
    append_fixed(&out, pose.timestamp, 9);
    for (const double v : {pose.T_w_c.t[0], pose.T_w_c.t[1], pose.T_w_c.t[2], q.x(), q.y(), q.z(), q.w()}) {
      out += ' ';
      append_fixed(&out, v, 12);
    }
    out += '\n';
  }
  return out;
}

void write_tum(const std::string& path, const std::vector<StampedPose>& poses) { write_file(path, format_tum(poses)); }

}  // namespace textslam
