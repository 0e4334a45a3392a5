// Picture: images side by side with results drawn on top, as one self-contained SVG.
#ifndef TEXTSLAM_STAGE_PICTURE_HPP
#define TEXTSLAM_STAGE_PICTURE_HPP

#include <string>
#include <utility>

#include "io/names.hpp"

namespace textslam {

/// Colours of all pictures: truth, first guess and result.
constexpr const char *kTruth = "#1e5adc", *kGuess = "#e07a10", *kFound = "#12a150";

class Picture {
 public:
  /// `file`: what save() writes; empty: it writes nothing.
  explicit Picture(std::string file) : file_(std::move(file)) {}
  /// The file is the program's only argument, if there is one.
  Picture(int argc, char** argv) : Picture(argc > 1 ? argv[1] : "") {}

  /// A panel to the right of those before.
  Picture& panel(ImageView8 image, const std::string& caption);
  /// Draws on the last panel.
  Picture& quad(const Quad<double>& quad, const char* colour);
  Picture& dot(const Vector2<double>& px, const char* colour);
  /// Throws std::runtime_error where the file cannot be written.
  void save() const;

 private:
  std::string file_, body_;
  double left_ = 0, width_ = 0, height_ = 0;
};

}  // namespace textslam

#endif  // TEXTSLAM_STAGE_PICTURE_HPP
