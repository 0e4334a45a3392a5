// The foreign tracker's map: frames with key points, points in the world, and their observations.
#ifndef FOREIGN_TRACKER_MAP_HPP
#define FOREIGN_TRACKER_MAP_HPP

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <memory>
#include <opencv2/core.hpp>
#include <utility>
#include <vector>

#include "foreign_tracker/se3.hpp"
#include "textplane/adapters/sophus.hpp"     // text
#include "textplane/landmarks/text_map.hpp"  // text

namespace foreign {

constexpr float kScale = 1.2F;  // between ORB's levels
constexpr int kLevels = 8;

struct Camera {
  double fx = 0, fy = 0, cx = 0, cy = 0;
  int width = 0, height = 0;

  Eigen::Vector2d project(const Eigen::Vector3d& p) const { return {fx * p[0] / p[2] + cx, fy * p[1] / p[2] + cy}; }
  Eigen::Vector3d ray(const cv::Point2f& px) const { return {(px.x - cx) / fx, (px.y - cy) / fy, 1}; }
  bool contains(const Eigen::Vector2d& px) const { return px[0] >= 0 && px[1] >= 0 && px[0] < width && px[1] < height; }
  cv::Matx33d matrix() const { return {fx, 0, cx, 0, fy, cy, 0, 0, 1}; }
};

struct Frame;

struct MapPoint {
  Eigen::Vector3d p_w;
  cv::Mat descriptor;
  double reach = 0;                                  // distance at which it is one pixel large on ORB's first level
  std::vector<std::pair<Frame*, std::size_t>> seen;  // key frames, key points
  std::size_t made = 0;                              // number of key frames when it was made
  int expected = 1, found = 1;                       // number of frames
  bool bad = false;
};

struct Frame {
  double time = 0;
  cv::Mat image;
  std::vector<cv::KeyPoint> keys;
  cv::Mat descriptors;
  std::vector<MapPoint*> points;                // of each key point, or null
  std::vector<std::vector<std::size_t>> cells;  // key points by cells of the image: matcher.hpp
  Se3 T_w_c;
  std::vector<textplane::TextDetection> quads;  // text

  double sigma(std::size_t key) const { return std::pow(kScale, keys[key].octave); }
  Eigen::Vector2d px(std::size_t key) const { return {keys[key].pt.x, keys[key].pt.y}; }
  int tracked() const {
    int n = 0;
    for (const MapPoint* p : points) n += p != nullptr;
    return n;
  }
  textplane::Pyramid pyramid() const { return textplane::Pyramid({image.data, image.cols, image.rows}); }  // text
  textplane::SE3d T_c_w() const { return textplane::adapters::from_sophus(T_w_c.inverse()); }              // text
  std::vector<textplane::TextPoint> text_points() const {                                                  // text
    std::vector<textplane::TextPoint> seen;                                                                // text
    for (std::size_t i = 0; i < points.size(); ++i)                                                        // text
      if (points[i]) seen.push_back(textplane::TextPoint::at(px(i), points[i]->p_w, -1, sigma(i)));        // text
    return seen;                                                                                           // text
  }                                                                                                        // text
};

/// Nothing is deleted, so that pointers stay valid; bad points are skipped.
struct Map {
  std::vector<std::unique_ptr<Frame>> key_frames;
  std::vector<std::unique_ptr<MapPoint>> points;
};

/// The key frames that share most points with `frame`, at least 15, without itself, best first.
std::vector<Frame*> covisible(const Map& map, const Frame& frame, std::size_t most);

}  // namespace foreign

#endif  // FOREIGN_TRACKER_MAP_HPP
