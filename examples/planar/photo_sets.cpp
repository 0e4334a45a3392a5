#include "planar/photo_sets.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <opencv2/core.hpp>
#include <utility>

#include "detectors/classical_detector.hpp"
#include "io/image_file.hpp"
#include "io/input_error.hpp"
#include "planar/peers.hpp"
#include "planar/registration.hpp"

namespace planar {

namespace {
using textslam::InputError;
using Matrix = tp::Matrix3<double>;

constexpr double kMinHeight = 20, kMinWidth = 60;  // px

Matrix read_homography(const std::string& path) {
  std::ifstream file(path);
  Matrix H;
  for (int i = 0; i < 9; ++i)
    if (!(file >> H(i / 3, i % 3))) throw InputError(path, 0, "not nine numbers");
  return H;
}
}  // namespace

std::vector<tp::Quad<double>> text_quads(const textslam::Image<std::uint8_t>& image,
                                         const std::vector<tp::Vector2<double>>& not_text) {
  std::vector<tp::Quad<double>> out;
  for (const auto& d : textslam::ClassicalDetector().detect({}, image.view())) {
    const auto& c = d.quad.corner;
    const bool text = std::none_of(not_text.begin(), not_text.end(),
                                   [&d](const tp::Vector2<double>& p) { return tp::contains(d.quad, p); });
    if (text && (c[0] - c[3]).norm() >= kMinHeight && (c[0] - c[1]).norm() >= kMinWidth &&
        tp::inside_image(d.quad, image.width(), image.height(), kBorder))
      out.push_back(d.quad);
  }
  return out;
}

std::vector<PhotoSet> read_still_scenes(const std::string& folder, const std::vector<std::string>& not_text,
                                        TruthPrecision* precision) {
  std::vector<PhotoSet> out;
  if (!std::filesystem::is_directory(folder)) throw InputError(folder, 0, "no such folder");
  std::vector<std::string> scenes;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.is_directory()) scenes.push_back(entry.path().string());
  std::sort(scenes.begin(), scenes.end());
  std::vector<std::vector<tp::Vector2<double>>> places(scenes.size());
  for (const std::string& place : not_text) {
    std::size_t scene = 0;
    double x = 0, y = 0;
    if (std::sscanf(place.c_str(), "%zu,%lf,%lf", &scene, &x, &y) != 3 || scene >= scenes.size())
      throw InputError(folder, 0, "has no place " + place);
    places[scene].emplace_back(x, y);
  }
  *precision = {};
  for (std::size_t s = 0; s < scenes.size(); ++s) {
    std::vector<std::string> files;
    for (const auto& entry : std::filesystem::directory_iterator(scenes[s])) files.push_back(entry.path().string());
    std::sort(files.begin(), files.end());
    if (files.size() < 2) throw InputError(scenes[s], 0, "fewer than two photographs");
    std::vector<cv::Mat> seen;
    for (const std::string& file : files) {
      const auto image = textslam::load_grey(file);
      seen.push_back(compare(cv::Mat(image.height(), image.width(), CV_8U, const_cast<std::uint8_t*>(image.data()))));
    }
    std::vector<std::vector<Registration>> from(files.size(), std::vector<Registration>(files.size()));
    for (std::size_t i = 0; i < files.size(); ++i)
      for (std::size_t j = i + 1; j < files.size(); ++j) from[i][j] = register_still(seen[i], seen[j]);

    PhotoSet set;
    set.first = files[0];
    set.others.assign(files.begin() + 1, files.end());
    set.not_text = places[s];
    for (std::size_t j = 1; j < files.size(); ++j) {
      set.truth.push_back(from[0][j].H);
      precision->residual += from[0][j].residual / static_cast<double>(set.others.size() * scenes.size());
    }
    std::vector<cv::Point2d> centres;
    for (const tp::Quad<double>& quad : text_quads(textslam::load_grey(files[0]), set.not_text))
      centres.emplace_back(tp::centroid(quad)[0], tp::centroid(quad)[1]);
    const Consistency round = round_trips(from, centres);
    precision->round_trip += round.mean / static_cast<double>(scenes.size());
    precision->largest_round_trip = std::max(precision->largest_round_trip, round.largest);
    out.push_back(std::move(set));
  }
  if (out.empty()) throw InputError(folder, 0, "no scenes");
  return out;
}

std::vector<PhotoSet> read_oxford(const std::string& folder) {
  PhotoSet set;
  set.text = false;
  set.first = folder + "/img1.png";
  for (int i = 2; i <= 6; ++i) {
    set.others.push_back(folder + "/img" + std::to_string(i) + ".png");
    Matrix H = read_homography(folder + "/H1to" + std::to_string(i) + "p.txt");
    refine_whole(textslam::load_grey(set.first).view(), textslam::load_grey(set.others.back()).view(), &H);
    set.truth.push_back(H);
  }
  return {set};
}

std::vector<PhotoSet> make_jpeg(const std::vector<std::string>& folders, const std::vector<int>& qualities) {
  std::vector<PhotoSet> out;
  for (const std::string& folder : folders) {
    PhotoSet set;
    set.text = false;
    set.first = folder + "/img1.png";
    set.others.assign(qualities.size(), set.first);
    set.truth.assign(qualities.size(), Matrix::Identity());
    set.jpeg = qualities;
    out.push_back(std::move(set));
  }
  return out;
}

}  // namespace planar
