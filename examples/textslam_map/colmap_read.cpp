// COLMAP's files, read: https://colmap.github.io/format.html
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <limits>
#include <set>

#include "io/camera_formats/formats.hpp"
#include "io/input_error.hpp"
#include "io/text_file.hpp"
#include "textplane/core/numeric.hpp"
#include "textslam_map/colmap_scene.hpp"

namespace textslam {
namespace {

SE3d read_pose(const std::array<double, 7>& numbers, const std::string& path, int line) {
  const Eigen::Quaterniond q(numbers[0], numbers[1], numbers[2], numbers[3]);
  const Vec3 t(numbers[4], numbers[5], numbers[6]);
  if (!(q.norm() > 0.5 && q.norm() < 2) || !t.allFinite()) throw InputError(path, line, "a pose that is none");
  return {q.normalized().toRotationMatrix(), t};
}

int id_of(double number, const std::string& path, int line) { return require_whole(number, path, line, "an id"); }

// Little-endian bytes.
class ByteReader {
 public:
  explicit ByteReader(const std::string& path) : path_(path), bytes_(read_file(path)) {}
  const std::string& path() const { return path_; }

  std::uint64_t next(std::size_t size) {
    if (size > bytes_.size() - at_) throw InputError(path_, 0, "it ends in the middle of its numbers");
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < size; ++i)
      value |= static_cast<std::uint64_t>(static_cast<unsigned char>(bytes_[at_ + i])) << (8 * i);
    at_ += size;
    return value;
  }
  std::uint64_t count() { return next(8); }
  int id() { return id_of(static_cast<double>(next(4)), path_, 0); }
  int grey() { return static_cast<int>(next(1)); }
  double number() {
    const std::uint64_t bits = next(8);
    double value = 0;
    std::memcpy(&value, &bits, sizeof value);
    return value;
  }
  std::string name() {
    const std::size_t end = bytes_.find('\0', at_);
    if (end == std::string::npos) throw InputError(path_, 0, "it ends in the middle of a name");
    std::string out = bytes_.substr(at_, end - at_);
    at_ = end + 1;
    return out;
  }

 private:
  std::string path_, bytes_;
  std::size_t at_ = 0;
};

void only_camera(std::uint64_t count, const std::string& path) {
  if (count != 1)
    throw InputError(path, 0, "it has " + std::to_string(count) + " cameras: a map has one, for all images");
}

void own_camera(int id, int camera, const std::string& path, int line) {
  if (id != camera)
    throw InputError(path, line, "an image of camera " + std::to_string(id) + ", which the model does not have");
}

ColmapScene read_binary(const std::string& folder) {
  ColmapScene scene;
  ByteReader cameras(folder + "/cameras.bin"), images(folder + "/images.bin"), points(folder + "/points3D.bin");
  only_camera(cameras.count(), cameras.path());
  scene.camera.id = cameras.id();
  const std::uint64_t model = cameras.next(4);
  if (model >= kColmapModels.size()) throw InputError(cameras.path(), 0, "a camera model that is not known");
  scene.camera.model = kColmapModels[model].name;
  scene.camera.width = require_whole(static_cast<double>(cameras.count()), cameras.path(), 0, "the width");
  scene.camera.height = require_whole(static_cast<double>(cameras.count()), cameras.path(), 0, "the height");
  for (int i = 0; i < kColmapModels[model].parameters; ++i) scene.camera.parameters.push_back(cameras.number());

  const std::uint64_t image_count = images.count();
  for (std::uint64_t i = 0; i < image_count; ++i) {
    ColmapScene::Image image;
    image.id = images.id();
    std::array<double, 7> pose{};
    for (double& number : pose) number = images.number();
    image.T_c_w = read_pose(pose, images.path(), 0);
    own_camera(images.id(), scene.camera.id, images.path(), 0);
    image.name = images.name();
    const std::uint64_t pixels = images.count();
    for (std::uint64_t k = 0; k < pixels; ++k) {
      const double x = images.number(), y = images.number();
      const std::uint64_t point = images.count();
      const bool seen = point != std::numeric_limits<std::uint64_t>::max();
      image.pixels.push_back({{x, y}, seen ? id_of(static_cast<double>(point), images.path(), 0) : -1});
    }
    scene.images.push_back(std::move(image));
  }

  const std::uint64_t point_count = points.count();
  for (std::uint64_t i = 0; i < point_count; ++i) {
    ColmapScene::Point point;
    point.id = id_of(static_cast<double>(points.count()), points.path(), 0);
    for (int k = 0; k < 3; ++k) point.p[k] = points.number();
    for (int k = 0; k < 3; ++k) point.grey += points.grey();
    point.grey /= 3;
    point.error = points.number();
    const std::uint64_t track = points.count();
    for (std::uint64_t k = 0; k < track; ++k) {
      const int image = points.id();
      point.track.emplace_back(image, static_cast<std::size_t>(points.id()));
    }
    scene.points.push_back(std::move(point));
  }
  return scene;
}

void read_texts(const std::string& folder, ColmapScene* scene) {
  const std::string images = folder + "/images.txt", points = folder + "/points3D.txt";
  const std::vector<TextLine> lines = model_lines(read_file(images));
  for (std::size_t i = 0; i < lines.size();) {
    const auto words = split_blanks(lines[i].text);
    if (words.empty()) {  // only the line of its pixels may be blank
      ++i;
      continue;
    }
    const int line = lines[i].number;
    if (words.size() < 10) throw InputError(images, line, "expected 'id qw qx qy qz tx ty tz camera name'");
    const auto number = [&](std::size_t k) { return require_number(words[k], images, line, "a number of the image"); };
    ColmapScene::Image image;
    image.id = id_of(number(0), images, line);
    own_camera(id_of(number(8), images, line), scene->camera.id, images, line);
    std::array<double, 7> pose{};
    for (std::size_t k = 0; k < 7; ++k) pose[k] = number(k + 1);
    image.T_c_w = read_pose(pose, images, line);
    image.name = lines[i].text.substr(static_cast<std::size_t>(words[9].data() - lines[i].text.data()));
    image.name = std::string(trimmed(image.name));
    if (i + 1 < lines.size()) {
      const auto pixels = split_blanks(lines[i + 1].text);
      const int below = lines[i + 1].number;
      if (pixels.size() % 3 != 0) throw InputError(images, below, "expected 'x y point' for each pixel");
      for (std::size_t k = 0; k < pixels.size(); k += 3) {
        const auto value = [&](std::size_t n) {
          return require_number(pixels[k + n], images, below, "a number of a pixel");
        };
        const double point = value(2);
        image.pixels.push_back({{value(0), value(1)}, point == -1 ? -1 : id_of(point, images, below)});
      }
    }
    scene->images.push_back(std::move(image));
    i += 2;
  }
  for (const TextLine& line : model_lines(read_file(points))) {
    const auto words = split_blanks(line.text);
    if (words.empty()) continue;
    if (words.size() < 8 || words.size() % 2 != 0)
      throw InputError(points, line.number, "expected 'id x y z r g b error' and pairs of image and pixel");
    const auto number = [&](std::size_t k) {
      return require_number(words[k], points, line.number, "a number of the point");
    };
    ColmapScene::Point point;
    point.id = id_of(number(0), points, line.number);
    point.p = {number(1), number(2), number(3)};
    point.grey = static_cast<int>(std::clamp((number(4) + number(5) + number(6)) / 3, 0.0, 255.0));
    point.error = number(7);
    for (std::size_t k = 8; k + 1 < words.size(); k += 2)
      point.track.emplace_back(id_of(number(k), points, line.number),
                               static_cast<std::size_t>(id_of(number(k + 1), points, line.number)));
    scene->points.push_back(std::move(point));
  }
}

void check(const ColmapScene& scene, const std::string& folder) {
  const auto refuse = [&](const std::string& what) { throw InputError(folder, 0, "the model has " + what); };
  std::set<int> ids, points;
  std::set<std::string> names;
  for (const ColmapScene::Point& point : scene.points) {
    if (!point.p.allFinite()) refuse("a point that is not finite");
    if (!points.insert(point.id).second) refuse("two points " + std::to_string(point.id));
  }
  for (const ColmapScene::Image& image : scene.images) {
    if (!ids.insert(image.id).second) refuse("two images " + std::to_string(image.id));
    if (!names.insert(image.name).second) refuse("two images named " + shown(image.name));
    if (!textplane::all_finite(image.T_c_w.inverse())) refuse("a pose that is not finite");
    for (const ColmapScene::Pixel& pixel : image.pixels) {
      if (!(pixel.px.x() >= 0 && pixel.px.y() >= 0 && pixel.px.x() <= scene.camera.width &&
            pixel.px.y() <= scene.camera.height))
        refuse("a pixel outside of its image, " + shown(image.name));
      if (pixel.point >= 0 && points.count(pixel.point) == 0)
        refuse("no point " + std::to_string(pixel.point) + ", which " + shown(image.name) + " sees");
    }
  }
}

}  // namespace

ColmapScene read_colmap_scene(const std::string& folder) {
  ColmapScene scene;
  std::error_code none;
  if (std::filesystem::exists(folder + "/cameras.bin", none)) {
    scene = read_binary(folder);
  } else {
    scene.camera = camera_of_text(read_file(folder + "/cameras.txt"), folder + "/cameras.txt");
    read_texts(folder, &scene);
  }
  check(scene, folder);
  return scene;
}

CameraModel camera_of(const ColmapScene& scene, const std::string& folder) {
  const ColmapScene::Camera& camera = scene.camera;
  std::vector<std::string> words = {std::to_string(camera.id), camera.model, std::to_string(camera.width),
                                    std::to_string(camera.height)};
  for (const double parameter : camera.parameters) words.push_back(shortest(parameter));
  return colmap_camera(folder, 0, {words.begin(), words.end()});
}

}  // namespace textslam
