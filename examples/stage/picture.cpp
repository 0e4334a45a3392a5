#include "stage/picture.hpp"

#include <algorithm>
#include <cstdio>

#include "io/data_uri.hpp"
#include "io/image_file.hpp"
#include "io/output_file.hpp"

namespace textslam {

namespace {
constexpr double kGap = 8, kCaption = 26;
constexpr int kQuality = 60;

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f", value);
  return text;
}
}  // namespace

Picture& Picture::panel(ImageView8 image, const std::string& caption) {
  left_ = width_ > 0 ? width_ + kGap : 0;
  width_ = left_ + image.width();
  height_ = std::max(height_, static_cast<double>(image.height()) + kCaption);
  if (file_.empty()) return *this;
  body_ += "<image x=\"" + number(left_) + "\" y=\"0\" width=\"" + std::to_string(image.width()) + "\" height=\"" +
           std::to_string(image.height()) + "\" href=\"" + jpeg_uri(encode_jpeg(image, kQuality)) + "\"/>\n<text x=\"" +
           number(left_ + 4) + "\" y=\"" + std::to_string(image.height() + 18) + "\">" + caption + "</text>\n";
  return *this;
}

Picture& Picture::quad(const Quad<double>& quad, const char* colour) {
  body_ += "<polygon points=\"";
  // The centre of the first pixel is (0, 0) for us and (0.5, 0.5) for SVG.
  for (const auto& p : quad.corner) body_ += number(left_ + p[0] + 0.5) + "," + number(p[1] + 0.5) + " ";
  body_ += std::string("\" fill=\"none\" stroke=\"") + colour + "\" stroke-width=\"2\"/>\n";
  return *this;
}

Picture& Picture::dot(const Vector2<double>& px, const char* colour) {
  body_ += "<circle cx=\"" + number(left_ + px[0] + 0.5) + "\" cy=\"" + number(px[1] + 0.5) + "\" r=\"4\" fill=\"" +
           colour + "\"/>\n";
  return *this;
}

void Picture::save() const {
  if (file_.empty()) return;
  write_file(file_, "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " + number(width_) + " " +
                        number(height_) + "\" font-family=\"sans-serif\" font-size=\"15\">\n" + body_ + "</svg>\n");
}

}  // namespace textslam
