#include "foreign_tracker/matcher.hpp"

#include <algorithm>
#include <opencv2/core/hal/hal.hpp>

namespace foreign {

namespace {

constexpr int kCell = 20;  // px, of Frame::cells
constexpr int kGrid = 32;  // px, of the grid from which key points are taken
constexpr std::size_t kKeys = 1200;

int bits(const cv::Mat& a, std::size_t i, const cv::Mat& b, std::size_t k) {
  return cv::hal::normHamming(a.ptr(static_cast<int>(i)), b.ptr(static_cast<int>(k)), 32);
}

int columns(const Camera& camera) { return camera.width / kCell + 1; }

struct Best {
  int first = 256, second = 256, key = -1;
  void offer(int distance, std::size_t k) {
    if (distance < first) {
      second = first;
      first = distance;
      key = static_cast<int>(k);
    } else {
      second = std::min(second, distance);
    }
  }
  bool good(int distance, double ratio) const { return key >= 0 && first <= distance && first <= ratio * second; }
};

// Pairs that are each other's best match.
Matches mutual(const std::vector<Best>& from_a, const std::vector<Best>& from_b, double ratio) {
  Matches out;
  for (std::size_t i = 0; i < from_a.size(); ++i) {
    if (!from_a[i].good(50, ratio)) continue;
    const auto k = static_cast<std::size_t>(from_a[i].key);
    if (from_b[k].key == static_cast<int>(i)) out.emplace_back(i, k);
  }
  return out;
}

}  // namespace

void extract(const Camera& camera, Frame& frame) {
  static const cv::Ptr<cv::ORB> orb = cv::ORB::create(5000, kScale, kLevels, 19, 0, 2, cv::ORB::HARRIS_SCORE, 31, 7);
  std::vector<cv::KeyPoint> all;
  orb->detect(frame.image, all);
  std::sort(all.begin(), all.end(),
            [](const cv::KeyPoint& a, const cv::KeyPoint& b) { return a.response > b.response; });
  // So many from each cell that the total is as wanted, starting from one.
  std::vector<std::vector<cv::KeyPoint>> grid(
      static_cast<std::size_t>((camera.width / kGrid + 1) * (camera.height / kGrid + 1)));
  for (const cv::KeyPoint& k : all)
    grid[static_cast<std::size_t>(static_cast<int>(k.pt.y) / kGrid * (camera.width / kGrid + 1) +
                                  static_cast<int>(k.pt.x) / kGrid)]
        .push_back(k);
  for (std::size_t rank = 0; frame.keys.size() < std::min(kKeys, all.size()); ++rank)
    for (const auto& cell : grid)
      if (rank < cell.size()) frame.keys.push_back(cell[rank]);
  orb->compute(frame.image, frame.keys, frame.descriptors);
  frame.points.assign(frame.keys.size(), nullptr);
  frame.cells.assign(static_cast<std::size_t>(columns(camera) * (camera.height / kCell + 1)), {});
  for (std::size_t i = 0; i < frame.keys.size(); ++i) {
    const cv::Point2f& px = frame.keys[i].pt;
    frame
        .cells[static_cast<std::size_t>(static_cast<int>(px.y) / kCell * columns(camera) +
                                        static_cast<int>(px.x) / kCell)]
        .push_back(i);
  }
}

int best_key(const Camera& camera, const MapPoint& point, double radius, int distance, double ratio,
             const Frame& frame) {
  const Eigen::Vector3d p = frame.T_w_c.inverse() * point.p_w;
  if (p[2] < 0.05) return -1;
  const Eigen::Vector2d at = camera.project(p);
  if (!camera.contains(at)) return -1;
  const int level =
      std::clamp(static_cast<int>(std::lround(std::log(point.reach / p.norm()) / std::log(kScale))), 0, kLevels - 1);
  const double r = radius * std::pow(kScale, level);
  const int rows = camera.height / kCell + 1;
  Best best;
  for (int y = std::max(0, static_cast<int>(at[1] - r) / kCell);
       y <= std::min(rows - 1, static_cast<int>(at[1] + r) / kCell); ++y)
    for (int x = std::max(0, static_cast<int>(at[0] - r) / kCell);
         x <= std::min(columns(camera) - 1, static_cast<int>(at[0] + r) / kCell); ++x)
      for (const std::size_t k : frame.cells[static_cast<std::size_t>(y * columns(camera) + x)]) {
        const cv::KeyPoint& key = frame.keys[k];
        if (std::abs(key.octave - level) > 1 || std::abs(key.pt.x - at[0]) > r || std::abs(key.pt.y - at[1]) > r)
          continue;
        best.offer(bits(point.descriptor, 0, frame.descriptors, k), k);
      }
  return best.good(distance, ratio) ? best.key : -1;
}

int match_by_projection(const Camera& camera, const std::vector<MapPoint*>& points, double radius, int distance,
                        double ratio, Frame& frame) {
  std::vector<MapPoint*> have(frame.points);
  std::sort(have.begin(), have.end());
  int found = 0;
  for (MapPoint* point : points) {
    if (!point || point->bad || std::binary_search(have.begin(), have.end(), point)) continue;
    const int k = best_key(camera, *point, radius, distance, ratio, frame);
    if (k < 0 || frame.points[static_cast<std::size_t>(k)]) continue;
    frame.points[static_cast<std::size_t>(k)] = point;
    ++found;
  }
  return found;
}

Matches match_by_descriptor(const Frame& a, const Frame& b, bool with_points, double ratio) {
  std::vector<Best> from_a(a.keys.size()), from_b(b.keys.size());
  for (std::size_t i = 0; i < a.keys.size(); ++i) {
    if (with_points && (!a.points[i] || a.points[i]->bad)) continue;
    for (std::size_t k = 0; k < b.keys.size(); ++k) {
      const int d = bits(a.descriptors, i, b.descriptors, k);
      from_a[i].offer(d, k);
      from_b[k].offer(d, i);
    }
  }
  return mutual(from_a, from_b, ratio);
}

Matches match_along_lines(const Camera& camera, const Frame& a, const Frame& b) {
  const Se3 T_b_a = b.T_w_c.inverse() * a.T_w_c;
  const Eigen::Vector3d t = T_b_a.translation();
  Eigen::Matrix3d cross;
  cross << 0, -t[2], t[1], t[2], 0, -t[0], -t[1], t[0], 0;
  const Eigen::Matrix3d E = cross * T_b_a.rotationMatrix();
  std::vector<Eigen::Vector3d> rays;
  for (const cv::KeyPoint& k : b.keys) rays.push_back(camera.ray(k.pt));
  std::vector<Best> from_a(a.keys.size()), from_b(b.keys.size());
  for (std::size_t i = 0; i < a.keys.size(); ++i) {
    if (a.points[i]) continue;
    const Eigen::Vector3d line = E * camera.ray(a.keys[i].pt);
    for (std::size_t k = 0; k < b.keys.size(); ++k) {
      if (b.points[k] || std::abs(a.keys[i].octave - b.keys[k].octave) > 2) continue;
      const double off = camera.fx * line.dot(rays[k]) / line.head<2>().norm();
      if (off * off > 3.84 * b.sigma(k) * b.sigma(k)) continue;
      const int d = bits(a.descriptors, i, b.descriptors, k);
      from_a[i].offer(d, k);
      from_b[k].offer(d, i);
    }
  }
  return mutual(from_a, from_b, 0.8);
}

std::vector<Frame*> covisible(const Map& map, const Frame& frame, std::size_t most) {
  std::vector<std::pair<int, Frame*>> shared;
  for (const auto& other : map.key_frames) {
    if (other.get() == &frame) continue;
    int n = 0;
    for (const MapPoint* p : frame.points)
      n += p && !p->bad &&
           std::any_of(p->seen.begin(), p->seen.end(), [&](const auto& s) { return s.first == other.get(); });
    if (n >= 15) shared.emplace_back(n, other.get());
  }
  std::stable_sort(shared.begin(), shared.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<Frame*> out;
  for (std::size_t i = 0; i < std::min(most, shared.size()); ++i) out.push_back(shared[i].second);
  return out;
}

}  // namespace foreign
