// COLMAP's binary model, read by its format's description, is its text model.
#include <gtest/gtest.h>

#include <cstring>
#include <sstream>

#include "io/text_file.hpp"
#include "map_file/map_file_support.hpp"
#include "textslam_map/export_map.hpp"

namespace textslam {
namespace colmap_binary_test {

using namespace map_file_support;
using Rows = std::vector<std::vector<double>>;  // a row an entry, its numbers in the order of the text

class Reader {
 public:
  explicit Reader(const std::string& path) : bytes_(read_file(path)) {}
  template <class T>
  double next() {
    T value{};
    EXPECT_LE(at_ + sizeof value, bytes_.size()) << "it ends too early";
    if (at_ + sizeof value <= bytes_.size()) std::memcpy(&value, bytes_.data() + at_, sizeof value);
    at_ += sizeof value;
    return static_cast<double>(value);
  }
  std::size_t count() { return static_cast<std::size_t>(next<std::uint64_t>()); }
  std::string name() {
    const std::string out = bytes_.c_str() + at_;
    at_ += out.size() + 1;
    return out;
  }
  bool at_end() const { return at_ == bytes_.size(); }

 private:
  std::string bytes_;
  std::size_t at_ = 0;
};

// The numbers of the rows of a text; words that are none go to `words`.
Rows numbers_of(const std::string& path, std::vector<std::string>* words) {
  Rows rows;
  std::istringstream text(read_file(path));
  for (std::string line; std::getline(text, line);) {
    if (!line.empty() && line[0] == '#') continue;
    rows.emplace_back();
    for (const std::string_view word : split_blanks(line)) {
      double value = 0;
      if (parse_number(word, &value))
        rows.back().push_back(value);
      else
        words->emplace_back(word);
    }
  }
  return rows;
}

Rows binary_cameras(const std::string& path, std::size_t parameters, double* model) {
  Reader in(path);
  Rows rows;
  for (std::size_t n = in.count(); n > 0; --n) {
    rows.push_back({in.next<std::uint32_t>()});
    *model = in.next<std::int32_t>();
    rows.back().push_back(in.next<std::uint64_t>());
    rows.back().push_back(in.next<std::uint64_t>());
    for (std::size_t i = 0; i < parameters; ++i) rows.back().push_back(in.next<double>());
  }
  EXPECT_TRUE(in.at_end()) << path;
  return rows;
}

Rows binary_images(const std::string& path, std::vector<std::string>* names) {
  Reader in(path);
  Rows rows;
  for (std::size_t n = in.count(); n > 0; --n) {
    rows.push_back({in.next<std::uint32_t>()});
    for (int i = 0; i < 7; ++i) rows.back().push_back(in.next<double>());
    rows.back().push_back(in.next<std::uint32_t>());
    names->push_back(in.name());
    rows.emplace_back();
    for (std::size_t pixels = in.count(); pixels > 0; --pixels) {
      rows.back().push_back(in.next<double>());
      rows.back().push_back(in.next<double>());
      rows.back().push_back(in.next<std::uint64_t>());
    }
  }
  EXPECT_TRUE(in.at_end()) << path;
  return rows;
}

Rows binary_points(const std::string& path) {
  Reader in(path);
  Rows rows;
  for (std::size_t n = in.count(); n > 0; --n) {
    rows.push_back({in.next<std::uint64_t>()});
    for (int i = 0; i < 3; ++i) rows.back().push_back(in.next<double>());
    for (int i = 0; i < 3; ++i) rows.back().push_back(in.next<std::uint8_t>());
    rows.back().push_back(in.next<double>());
    for (std::size_t track = in.count(); track > 0; --track) {
      rows.back().push_back(in.next<std::uint32_t>());
      rows.back().push_back(in.next<std::uint32_t>());
    }
  }
  EXPECT_TRUE(in.at_end()) << path;
  return rows;
}

class ColmapBinary : public MapFileTest {
 protected:
  void expect_same(const std::string& model, double number, std::size_t count) {
    save();
    const std::string out = folder.path("colmap");
    export_colmap(load(), out);
    std::vector<std::string> models, names, binary_names, none;
    double found = -1;
    EXPECT_EQ(numbers_of(out + "/cameras.txt", &models), binary_cameras(out + "/cameras.bin", count, &found));
    EXPECT_EQ(models, std::vector<std::string>{model});
    EXPECT_EQ(found, number);
    const Rows images = numbers_of(out + "/images.txt", &names);
    EXPECT_EQ(images.size(), 4u);
    EXPECT_EQ(images, binary_images(out + "/images.bin", &binary_names));
    EXPECT_EQ(names, binary_names);
    const Rows points = numbers_of(out + "/points3D.txt", &none);
    EXPECT_EQ(points.size(), 4u);
    EXPECT_EQ(points, binary_points(out + "/points3D.bin"));
  }
};

TEST_F(ColmapBinary, IsTheTextModel) { expect_same("PINHOLE", 1, 4); }

TEST_F(ColmapBinary, KnowsTheNumberOfEachCamera) {
  record.camera.raw = RadialTangential<double>{{262, 262, 159.5, 119.5}, -0.28, 0.07, 1e-3, -5e-4, 0};
  expect_same("OPENCV", 4, 8);
  record.camera.raw = RadialTangential<double>{{262, 262, 159.5, 119.5}, -0.28, 0.07, 1e-3, -5e-4, 0.01};
  expect_same("FULL_OPENCV", 6, 12);
}

// Without an observation a key frame has an empty line of pixels.
TEST_F(ColmapBinary, AKeyFrameWithoutPoints) {
  for (int i = 0; i < 5; ++i) drop_point(map, i);
  save();
  const std::string out = folder.path("colmap");
  export_colmap(load(), out);
  std::vector<std::string> names;
  const Rows images = binary_images(out + "/images.bin", &names);
  ASSERT_EQ(images.size(), 4u);
  EXPECT_TRUE(images[1].empty() && images[3].empty());
  EXPECT_TRUE(binary_points(out + "/points3D.bin").empty());
}

}  // namespace colmap_binary_test
}  // namespace textslam
