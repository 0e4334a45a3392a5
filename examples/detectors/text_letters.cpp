#include "detectors/text_letters.hpp"

#include <algorithm>
#include <cmath>

#include "detectors/text_ink.hpp"

namespace textslam {
namespace {

using Point = Vector2<double>;

bool has_letter_shape(const Piece& piece, const ImageView8& image, const ClassicalParameters& parameters) {
  const int longer = std::max(piece.width(), piece.height()), shorter = std::min(piece.width(), piece.height());
  if (longer < parameters.min_size || longer > parameters.max_size || piece.area < parameters.min_area) return false;
  if (piece.x0 == 0 || piece.y0 == 0 || piece.x1 == image.width() - 1 || piece.y1 == image.height() - 1) return false;
  if (longer > parameters.max_aspect * shorter) return false;
  if (piece.area < parameters.min_extent * piece.width() * piece.height()) return false;
  // Runs and their joints are a graph: each of its cycles goes round a hole.
  return piece[0].joints - piece.count + 1 <= parameters.max_holes;
}

struct Moments {
  int n = 0;
  double sum = 0, squares = 0;
  void add(double v) {
    ++n;
    sum += v;
    squares += v * v;
  }
  double mean() const { return n > 0 ? sum / n : 0.0; }
  double deviation() const { return n > 0 ? std::sqrt(std::max(0.0, squares / n - mean() * mean())) : 0.0; }
};

/// Ink and paper of the letter; false where they do not stand out from each other or are not even.
bool measure_tones(const Piece& piece, const ImageView8& image, const ClassicalParameters& parameters, Letter& letter) {
  Moments ink, paper;
  for (int i = 0; i < piece.count; ++i) {
    const PixelRun& run = piece[i];
    const std::uint8_t* row = image.row(run.y);
    for (int x = run.x0; x <= run.x1; ++x) ink.add(row[x]);
    // The first pixels outside are blurred; the farther ones may belong to the next letter.
    for (const int x : {run.x0 - 1, run.x1 + 1}) {
      const int beyond = std::clamp(x < run.x0 ? x - 1 : x + 1, 0, image.width() - 1);
      paper.add(letter.light ? std::min(row[x], row[beyond]) : std::max(row[x], row[beyond]));
    }
  }
  letter.ink = ink.mean();
  letter.paper = paper.mean();
  const double contrast = letter.contrast();
  return contrast >= parameters.min_contrast && paper.deviation() <= parameters.max_paper_spread * contrast &&
         ink.deviation() <= parameters.max_ink_spread * contrast;
}

/// Stroke width from the distance of each pixel to the paper (chamfer 3-4); false where it varies too much.
bool measure_stroke(const Piece& piece, const ClassicalParameters& parameters, std::vector<int>& distance,
                    Letter& letter) {
  const int stride = piece.width() + 2, rows = piece.height() + 2, far = 1 << 20;
  distance.assign(at(stride * rows), 0);
  for (int i = 0; i < piece.count; ++i) {
    int* row = distance.data() + (piece[i].y - piece.y0 + 1) * stride + 1 - piece.x0;
    for (int x = piece[i].x0; x <= piece[i].x1; ++x) row[x] = far;
  }
  for (int y = 1; y + 1 < rows; ++y)
    for (int x = 1; x + 1 < stride; ++x) {
      int* d = distance.data() + y * stride + x;
      if (*d > 0) *d = std::min({*d, d[-1] + 3, d[-stride] + 3, d[-stride - 1] + 4, d[-stride + 1] + 4});
    }
  Moments all, ridge;
  for (int y = rows - 2; y > 0; --y)
    for (int x = stride - 2; x > 0; --x) {
      int* d = distance.data() + y * stride + x;
      if (*d > 0) *d = std::min({*d, d[1] + 3, d[stride] + 3, d[stride + 1] + 4, d[stride - 1] + 4});
    }
  for (int y = 1; y + 1 < rows; ++y)
    for (int x = 1; x + 1 < stride; ++x) {
      const int* d = distance.data() + y * stride + x;
      if (*d == 0) continue;
      all.add(*d / 3.0);
      if (*d >= std::max({d[1], d[-1], d[stride], d[-stride]})) ridge.add(*d / 3.0);
    }
  // In a stroke of width w the distance is w / 4 + 1 / 2 on average.
  letter.stroke = std::max(1.0, 4.0 * all.mean() - 2.0);
  return letter.stroke <= parameters.max_stroke * letter.size &&
         ridge.deviation() <= parameters.max_stroke_spread * ridge.mean();
}

}  // namespace

Extent extent(const Letter& letter, const Vector2<double>& direction) {
  Extent e{letter.outline[0].dot(direction), letter.outline[0].dot(direction)};
  for (const Point& p : letter.outline) {
    const double s = p.dot(direction);
    e.low = std::min(e.low, s);
    e.high = std::max(e.high, s);
  }
  return e;
}

void find_letters(const ImageView8& image, const Image<std::uint8_t>& ink, const ClassicalParameters& parameters,
                  LetterScratch& scratch, std::vector<Letter>& letters) {
  letters.clear();
  scratch.pieces.find(ink.view(), Touch::sides);  // what touches by corners would tie letters together
  Letter letter;
  for (int p = 0; p < scratch.pieces.size(); ++p) {
    if (scratch.pieces.runs_of(p) < 2) continue;
    const Piece piece = scratch.pieces[p];
    if (!has_letter_shape(piece, image, parameters)) continue;
    letter.light = piece[0].value == kLightInk;
    letter.centre = {0.5 * (piece.x0 + piece.x1), 0.5 * (piece.y0 + piece.y1)};
    letter.size = std::max(piece.width(), piece.height());
    letter.area = piece.area;
    if (!measure_tones(piece, image, parameters, letter)) continue;
    if (!measure_stroke(piece, parameters, scratch.distance, letter)) continue;
    trace_outline(piece, 0.5, letter.outline);
    letters.push_back(letter);
  }
}

}  // namespace textslam
