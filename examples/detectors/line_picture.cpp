#include "detectors/line_picture.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "io/text_file.hpp"
#include "textplane/geometry/quad.hpp"
#include "textplane/photometry/sample.hpp"

namespace textslam {

std::uint8_t grey_at(ImageView8 image, double x, double y) {
  double value = 0;
  textplane::sample_bilinear(image, std::clamp(x, 0.0, image.width() - 1.0), std::clamp(y, 0.0, image.height() - 1.0),
                             &value);
  return static_cast<std::uint8_t>(std::lround(value));
}

Image<std::uint8_t> line_picture(ImageView8 image, const Quad<double>& quad, int height, double margin,
                                 double longest) {
  const auto& c = quad.corner;
  const double wide = std::max((c[1] - c[0]).norm(), (c[2] - c[3]).norm());
  const double high = std::max((c[3] - c[0]).norm(), (c[2] - c[1]).norm());
  if (!image.valid() || !textplane::all_finite(quad) || !(high >= 4) || !(wide >= 4)) return {};
  const double rows = height * (1 + 2 * margin);
  const double columns = height * std::min(wide / high, longest) + 2 * margin * height;
  Image<std::uint8_t> picture(static_cast<int>(columns), static_cast<int>(rows));
  for (int y = 0; y < picture.height(); ++y)
    for (int x = 0; x < picture.width(); ++x) {
      const double u = (x + 0.5) / columns * (1 + 2 * margin * high / wide) - margin * high / wide;
      const double v = (y + 0.5) / rows * (1 + 2 * margin) - margin;
      const Vector2<double> p = (1 - v) * ((1 - u) * c[0] + u * c[1]) + v * ((1 - u) * c[3] + u * c[2]);
      picture(x, y) = grey_at(image, p.x(), p.y());
    }
  return picture;
}

std::string word_of(std::string reading) {
  for (std::size_t at = 0; (at = reading.find("\xE2\x80", at)) != std::string::npos;)
    reading.erase(at, 3);  // dashes and quotes
  const auto is_letter = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || (c & 0x80) != 0; };
  const auto first = std::find_if(reading.begin(), reading.end(), is_letter);
  const auto last = std::find_if(reading.rbegin(), reading.rend(), is_letter).base();
  if (first >= last) return "";
  const std::string inner(first, last);
  const auto begins_letter = [&](char c) { return is_letter(c) && (c & 0xC0) != 0x80; };
  return std::count_if(inner.begin(), inner.end(), begins_letter) < 2 ? "" : well_formed_utf8(inner);
}

}  // namespace textslam
