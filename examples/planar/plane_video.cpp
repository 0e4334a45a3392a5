#include "planar/plane_video.hpp"

#include <cstdio>
#include <fstream>
#include <iterator>

#include "io/image_file.hpp"
#include "io/input_error.hpp"

namespace planar {

tp::Image<std::uint8_t> PlaneVideo::load(int frame) const {
  char name[32];
  std::snprintf(name, sizeof name, "/%08d.jpg", frame);
  return textslam::load_grey(images + name);
}

tp::Quad<double> PlaneVideo::corners(int frame) const {
  const auto after = truth.lower_bound(frame);
  if (after == truth.end()) return truth.rbegin()->second;
  if (after->first == frame || after == truth.begin()) return after->second;
  const auto before = std::prev(after);
  const double share = static_cast<double>(frame - before->first) / (after->first - before->first);
  tp::Quad<double> out;
  for (std::size_t i = 0; i < 4; ++i)
    out.corner[i] = (1 - share) * before->second.corner[i] + share * after->second.corner[i];
  return out;
}

PlaneVideo read_plane_video(const std::string& folder, const std::string& sequence) {
  const std::string path = folder + "/" + sequence + "_gt_corners.csv";
  std::ifstream file(path);
  if (!file) throw textslam::InputError(path, 0, "cannot be read");
  PlaneVideo out{folder + "/" + sequence, {}};
  std::string line;
  std::getline(file, line);
  for (int number = 2; std::getline(file, line); ++number) {
    int frame = 0, flag = 0;
    tp::Quad<double> q;
    auto& c = q.corner;
    if (std::sscanf(line.c_str(), "%d,%d,%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf", &frame, &flag, &c[0][0], &c[0][1], &c[1][0],
                    &c[1][1], &c[2][0], &c[2][1], &c[3][0], &c[3][1]) != 10)
      throw textslam::InputError(path, number, "not frame,flag and eight numbers");
    if (flag == 0) out.truth[frame] = q;
  }
  if (out.truth.size() < 2 || out.truth.begin()->first != 1)
    throw textslam::InputError(path, 0, "no corners of frame 1");
  return out;
}

double corner_error(const tp::Quad<double>& a, const tp::Quad<double>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < 4; ++i) sum += (a.corner[i] - b.corner[i]).norm() / 4;
  return sum;
}

}  // namespace planar
