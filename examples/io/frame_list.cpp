#include "io/frame_list.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <utility>

#include "io/input_error.hpp"
#include "io/paths.hpp"
#include "io/text_file.hpp"

namespace textslam {

namespace fs = std::filesystem;

namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

// Removes the digits at the front of `text` and returns them without leading zeros.
std::string_view take_number(std::string_view* text) {
  std::size_t zeros = 0;
  while (zeros < text->size() && (*text)[zeros] == '0') ++zeros;
  std::size_t end = zeros;
  while (end < text->size() && is_digit((*text)[end])) ++end;
  const std::string_view number = text->substr(zeros, end - zeros);
  text->remove_prefix(end);
  return number;
}

constexpr std::array<const char*, 5> kRead = {".png", ".jpg", ".jpeg", ".pgm", ".ppm"};
// Those that cameras and programs write, and that are not read.
constexpr std::array<const char*, 11> kOtherImages = {".webp", ".heic", ".heif", ".avif", ".bmp", ".tif",
                                                      ".tiff", ".gif",  ".jxl",  ".dng",  ".exr"};

std::string extension_of(const fs::path& name) {
  std::string extension = name.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(), lower);
  return name.string().front() == '.' ? "" : extension;
}

template <class Kinds>
bool is_among(const Kinds& kinds, const std::string& extension) {
  return std::find(kinds.begin(), kinds.end(), extension) != kinds.end();
}

InputError no_images(const std::string& folder, const std::map<std::string, int>& others) {
  std::string what =
      "the folder has neither images.txt nor rgb.txt, no mav0/cam0, and no images that are read: JPEG, "
      "PNG, PGM, PPM";
  for (const auto& [extension, count] : others)
    what += "; " + std::to_string(count) + " *" + extension + (count == 1 ? " is" : " are") + " to be converted first";
  return InputError(folder, 0, what);
}

}  // namespace

bool natural_less(std::string_view a, std::string_view b) {
  std::string_view x = a, y = b;
  while (!x.empty() && !y.empty()) {
    if (is_digit(x.front()) && is_digit(y.front())) {
      const std::string_view m = take_number(&x), n = take_number(&y);
      if (m.size() != n.size()) return m.size() < n.size();
      if (m != n) return m < n;
    } else {
      if (x.front() != y.front()) return static_cast<unsigned char>(x.front()) < static_cast<unsigned char>(y.front());
      x.remove_prefix(1);
      y.remove_prefix(1);
    }
  }
  if (x.empty() != y.empty()) return x.empty();
  return a < b;
}

std::string find_list(const std::string& folder) {
  for (const char* name : {"images.txt", "rgb.txt"}) {
    const fs::path list = fs::path(folder) / name;
    if (is_there(list)) return list.string();
  }
  return "";
}

std::vector<FrameRef> read_frame_list(const std::string& folder, const std::string& list) {
  std::vector<FrameRef> frames;
  for (const TextLine& line : read_lines(list)) {
    const std::string_view text = trimmed(line.text);
    if (text[0] == '#') continue;
    const std::string_view time = split_blanks(text).front();
    const std::string path(trimmed(text.substr(time.size())));
    FrameRef frame;
    frame.line = line.number;
    frame.timestamp = require_number(time, list, line.number, "the timestamp");
    if (path.empty()) throw InputError(list, line.number, "the image's path is missing after the timestamp");
    if (!frames.empty() && !(frame.timestamp > frames.back().timestamp)) {
      throw InputError(
          list, line.number,
          "times must increase: " + shown(time) + " does not follow line " + std::to_string(frames.back().line));
    }
    frame.path = (fs::path(folder) / path).string();
    frame.stem = fs::path(path).stem().string();
    frames.push_back(std::move(frame));
  }
  if (frames.empty()) throw InputError(list, 0, "the list names no image");
  return frames;
}

std::vector<std::string> image_names(const std::string& folder) {
  std::vector<std::string> names;
  std::map<std::string, int> others;
  std::error_code error;
  fs::directory_iterator entry(folder, error);
  for (; !error && entry != fs::directory_iterator(); entry.increment(error)) {
    const fs::path name = entry->path().filename();
    std::error_code ignored;
    if (entry->is_directory(ignored)) continue;
    const std::string extension = extension_of(name);
    if (is_among(kRead, extension)) names.push_back(name.string());
    if (is_among(kOtherImages, extension)) ++others[extension];
  }
  if (error) throw InputError(folder, 0, error.message());
  if (names.empty()) throw no_images(folder, others);
  std::sort(names.begin(), names.end(), natural_less);
  return names;
}

std::vector<FrameRef> number_frames(const std::string& folder, const std::vector<std::string>& names, double fps) {
  std::vector<FrameRef> frames;
  for (const std::string& name : names) {
    FrameRef frame;
    frame.timestamp = static_cast<double>(frames.size()) / fps;
    frame.path = (fs::path(folder) / name).string();
    frame.stem = fs::path(name).stem().string();
    frames.push_back(std::move(frame));
  }
  return frames;
}

}  // namespace textslam
