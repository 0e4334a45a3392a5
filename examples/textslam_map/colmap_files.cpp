// COLMAP's files: https://colmap.github.io/format.html
#include <cstdint>
#include <cstring>

#include "io/input_error.hpp"
#include "io/text_file.hpp"
#include "textslam_map/colmap_scene.hpp"

namespace textslam {
namespace {

std::string joined(const std::vector<double>& numbers) {
  std::string out;
  for (const double number : numbers) out += (out.empty() ? "" : " ") + shortest(number);
  return out;
}

std::vector<double> pose_of(const ColmapScene::Image& image) {
  const Eigen::Quaterniond q(image.T_c_w.R);
  const Vec3& t = image.T_c_w.t;
  return {q.w(), q.x(), q.y(), q.z(), t.x(), t.y(), t.z()};
}

// Little-endian on any machine.
class Bytes {
 public:
  template <class Unsigned>
  void add(Unsigned value) {
    for (std::size_t i = 0; i < sizeof value; ++i) bytes_.push_back(static_cast<char>((value >> (8 * i)) & 0xff));
  }
  void add_number(double value) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    add(bits);
  }
  void add_id(int id) { add(static_cast<std::uint32_t>(id)); }
  void add_count(std::size_t count) { add(static_cast<std::uint64_t>(count)); }
  void add_grey(int grey) { bytes_.push_back(static_cast<char>(grey)); }
  void add_name(const std::string& name) { bytes_.append(name.c_str(), name.size() + 1); }
  std::string take() { return std::move(bytes_); }

 private:
  std::string bytes_;
};

std::uint32_t number_of(const std::string& model) {
  for (std::size_t i = 0; i < kColmapModels.size(); ++i)
    if (model == kColmapModels[i].name) return static_cast<std::uint32_t>(i);
  throw InputError("cameras.bin", 0, "COLMAP has no number for the camera model " + model);
}

}  // namespace

std::string colmap_images_text(const ColmapScene& scene) {
  std::string out = "# IMAGE_ID QW QX QY QZ TX TY TZ CAMERA_ID NAME\n# X Y POINT3D_ID ...\n";
  for (const ColmapScene::Image& image : scene.images) {
    out += std::to_string(image.id) + " " + joined(pose_of(image)) + " " + std::to_string(scene.camera.id) + " " +
           image.name + "\n";
    bool first = true;
    for (const ColmapScene::Pixel& pixel : image.pixels) {
      out += (first ? "" : " ") + joined({pixel.px.x(), pixel.px.y()}) + " " + std::to_string(pixel.point);
      first = false;
    }
    out += "\n";
  }
  return out;
}

std::string colmap_points_text(const ColmapScene& scene) {
  std::string out = "# POINT3D_ID X Y Z R G B ERROR (IMAGE_ID POINT2D_IDX) ...\n";
  for (const ColmapScene::Point& point : scene.points) {
    const std::string grey = " " + std::to_string(point.grey);
    out += std::to_string(point.id) + " " + joined({point.p.x(), point.p.y(), point.p.z()}) + grey + grey + grey + " " +
           shortest(point.error);
    for (const auto& [image, place] : point.track) out += " " + std::to_string(image) + " " + std::to_string(place);
    out += "\n";
  }
  return out;
}

std::string colmap_cameras_binary(const ColmapScene& scene) {
  const ColmapScene::Camera& camera = scene.camera;
  Bytes out;
  out.add_count(1);
  out.add_id(camera.id);
  out.add(number_of(camera.model));
  out.add_count(static_cast<std::size_t>(camera.width));
  out.add_count(static_cast<std::size_t>(camera.height));
  for (const double parameter : camera.parameters) out.add_number(parameter);
  return out.take();
}

std::string colmap_images_binary(const ColmapScene& scene) {
  Bytes out;
  out.add_count(scene.images.size());
  for (const ColmapScene::Image& image : scene.images) {
    out.add_id(image.id);
    for (const double number : pose_of(image)) out.add_number(number);
    out.add_id(scene.camera.id);
    out.add_name(image.name);
    out.add_count(image.pixels.size());
    for (const ColmapScene::Pixel& pixel : image.pixels) {
      out.add_number(pixel.px.x());
      out.add_number(pixel.px.y());
      out.add_count(static_cast<std::size_t>(pixel.point));
    }
  }
  return out.take();
}

std::string colmap_points_binary(const ColmapScene& scene) {
  Bytes out;
  out.add_count(scene.points.size());
  for (const ColmapScene::Point& point : scene.points) {
    out.add_count(static_cast<std::size_t>(point.id));
    for (const double number : {point.p.x(), point.p.y(), point.p.z()}) out.add_number(number);
    for (int i = 0; i < 3; ++i) out.add_grey(point.grey);
    out.add_number(point.error);
    out.add_count(point.track.size());
    for (const auto& [image, place] : point.track) {
      out.add_id(image);
      out.add_id(static_cast<int>(place));
    }
  }
  return out.take();
}

}  // namespace textslam
