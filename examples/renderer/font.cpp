#include "renderer/font.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>

#define STBTT_STATIC
#define STB_TRUETYPE_IMPLEMENTATION
#include <stb/stb_truetype.h>

namespace textslam {

namespace fs = std::filesystem;

struct Font::Face {
  std::vector<unsigned char> bytes;
  stbtt_fontinfo info{};
  int cap_height = 0;  // font units
};

Font::Font(const std::string& path) : face_(std::make_unique<Face>()) {
  std::ifstream in(path, std::ios::binary);
  face_->bytes.assign(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
  const auto unusable = [&path] { return std::runtime_error(path + ": not a usable TrueType font"); };
  // stb_truetype trusts its input: refuse at least what is no font at all.
  if (face_->bytes.size() < 1024) throw unusable();
  const int offset = stbtt_GetFontOffsetForIndex(face_->bytes.data(), 0);
  if (offset < 0 || !stbtt_InitFont(&face_->info, face_->bytes.data(), offset)) throw unusable();
  for (int letter = 'A'; letter <= 'Z'; ++letter) {
    if (stbtt_FindGlyphIndex(&face_->info, letter) == 0) throw unusable();
  }
  int x0, y0, x1, y1;
  if (!stbtt_GetCodepointBox(&face_->info, 'H', &x0, &y0, &x1, &y1) || y1 <= 0) throw unusable();
  face_->cap_height = y1;
}

Font::~Font() = default;
Font::Font(Font&&) noexcept = default;
Font& Font::operator=(Font&&) noexcept = default;

Ink Font::draw(const std::string& word, double cap_height) const {
  const stbtt_fontinfo* info = &face_->info;
  const float scale = static_cast<float>(cap_height / face_->cap_height);
  struct Glyph {
    int code, x, y, width, height;
    float shift;
  };
  std::vector<Glyph> glyphs;
  double pen = 0.0;
  int left = 1 << 20, top = 1 << 20, right = -(1 << 20), bottom = -(1 << 20);
  for (std::size_t i = 0; i < word.size(); ++i) {
    const int code = static_cast<unsigned char>(word[i]);
    const double whole = std::floor(pen);
    const float shift = static_cast<float>(pen - whole);
    int x0, y0, x1, y1, advance, bearing;
    stbtt_GetCodepointBitmapBoxSubpixel(info, code, scale, scale, shift, 0.0F, &x0, &y0, &x1, &y1);
    stbtt_GetCodepointHMetrics(info, code, &advance, &bearing);
    if (x1 > x0 && y1 > y0) {
      const int x = static_cast<int>(whole) + x0;
      glyphs.push_back({code, x, y0, x1 - x0, y1 - y0, shift});
      left = std::min(left, x);
      right = std::max(right, x + x1 - x0);
      top = std::min(top, y0);
      bottom = std::max(bottom, y1);
    }
    pen += static_cast<double>(scale) * advance;
    if (i + 1 < word.size()) {
      pen += static_cast<double>(scale) *
             stbtt_GetCodepointKernAdvance(info, code, static_cast<unsigned char>(word[i + 1]));
    }
  }
  if (glyphs.empty()) return {};
  Ink ink(right - left, bottom - top);
  std::vector<unsigned char> bitmap;
  for (const Glyph& glyph : glyphs) {
    bitmap.assign(static_cast<std::size_t>(glyph.width) * static_cast<std::size_t>(glyph.height), 0);
    stbtt_MakeCodepointBitmapSubpixel(info, bitmap.data(), glyph.width, glyph.height, glyph.width, scale, scale,
                                      glyph.shift, 0.0F, glyph.code);
    for (int y = 0; y < glyph.height; ++y) {
      for (int x = 0; x < glyph.width; ++x) {
        // Kerned glyphs may share a texel.
        std::uint8_t& texel = ink(glyph.x - left + x, glyph.y - top + y);
        texel = std::max(
            texel,
            bitmap[static_cast<std::size_t>(y) * static_cast<std::size_t>(glyph.width) + static_cast<std::size_t>(x)]);
      }
    }
  }
  return ink;
}

namespace {

std::vector<fs::path> font_files(const std::vector<std::string>& folders) {
  std::vector<fs::path> files;
  for (const std::string& folder : folders) {
    std::error_code error;
    const auto options = fs::directory_options::skip_permission_denied;
    for (fs::recursive_directory_iterator it(folder, options, error), end; !error && it != end; it.increment(error)) {
      std::error_code ignored;
      if (it->path().extension() == ".ttf" && it->is_regular_file(ignored)) files.push_back(it->path());
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace

std::vector<Font> load_fonts(const std::vector<std::string>& folders) {
  const std::vector<fs::path> files = font_files(folders);
  std::vector<Font> fonts;
  for (const char* name : {"DejaVuSans-Bold", "DejaVuSansCondensed-Bold", "DejaVuSerif-Bold", "DejaVuSansMono-Bold"}) {
    const auto file = std::find_if(files.begin(), files.end(), [name](const fs::path& f) { return f.stem() == name; });
    if (file != files.end()) fonts.emplace_back(file->string());
  }
  // Another family will do: its heavy faces if it has some.
  for (const bool only_bold : {true, false}) {
    for (const fs::path& file : files) {
      if (!fonts.empty()) return fonts;
      if (only_bold && file.stem().string().find("Bold") == std::string::npos) continue;
      try {
        fonts.emplace_back(file.string());
      } catch (const std::runtime_error&) {
        // Symbol fonts have no letters: try the next file.
      }
    }
  }
  if (!fonts.empty()) return fonts;
  std::string searched;
  for (const std::string& folder : folders) searched += (searched.empty() ? "" : ", ") + folder;
  throw std::runtime_error("no TrueType font found in " + searched +
                           ": install one, for example Debian's package fonts-dejavu-core");
}

std::vector<Font> load_fonts() {
  std::vector<std::string> folders = {"/usr/share/fonts", "/usr/local/share/fonts", "/Library/Fonts"};
  if (const char* home = std::getenv("HOME")) {
    folders.push_back(std::string(home) + "/.local/share/fonts");
    folders.push_back(std::string(home) + "/.fonts");
  }
  return load_fonts(folders);
}

}  // namespace textslam
