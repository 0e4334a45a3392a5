// Fonts: TrueType files found on this machine, and words drawn with them.
#ifndef TEXTSLAM_RENDERER_FONT_HPP
#define TEXTSLAM_RENDERER_FONT_HPP

#include <memory>
#include <string>
#include <vector>

#include "io/names.hpp"

namespace textslam {

/// Ink of a word: 0 (paper) to 255, cropped to the ink on all four sides.
using Ink = Image<std::uint8_t>;

class Font {
 public:
  /// Throws std::runtime_error that names the file when it is not a TrueType font with the capital letters.
  explicit Font(const std::string& path);
  ~Font();
  Font(Font&&) noexcept;
  Font& operator=(Font&&) noexcept;

  /// The word with capitals `cap_height` texels high. Empty when the font has none of its glyphs.
  Ink draw(const std::string& word, double cap_height) const;

 private:
  struct Face;
  std::unique_ptr<Face> face_;
};

/// The fonts of signs: the bold DejaVu faces where they are installed, else any TrueType font with the capital letters.
/// Searches the usual font folders of Linux and macOS. Throws std::runtime_error that names the package to install when
/// there is none.
std::vector<Font> load_fonts();
/// The same with the folders given.
std::vector<Font> load_fonts(const std::vector<std::string>& folders);

}  // namespace textslam

#endif  // TEXTSLAM_RENDERER_FONT_HPP
