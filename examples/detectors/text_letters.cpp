#include "detectors/text_letters.hpp"

#include <algorithm>
#include <cmath>

#include "detectors/text_ink.hpp"

namespace textslam {
namespace {

using Point = Vector2<double>;

int root_of(std::vector<InkRun>& runs, int i) {
  while (runs[at(i)].parent != i) {
    runs[at(i)].parent = runs[at(runs[at(i)].parent)].parent;
    i = runs[at(i)].parent;
  }
  return i;
}

/// Runs a and b touch. The earlier root stays, so that results do not depend on the order of joins.
void join(std::vector<InkRun>& runs, int a, int b) {
  const int i = root_of(runs, a), j = root_of(runs, b);
  const int low = std::min(i, j), high = std::max(i, j);
  if (low != high) {
    runs[at(high)].parent = low;
    runs[at(low)].joints += runs[at(high)].joints;
  }
  ++runs[at(low)].joints;
}

/// Fills scratch.runs; runs of neighbouring rows touch where they share a column (4-connectivity keeps letters apart).
void collect_runs(const Image<std::uint8_t>& ink, std::vector<InkRun>& runs) {
  runs.clear();
  int above = 0, above_end = 0;
  for (int y = 0; y < ink.height(); ++y) {
    const int start = static_cast<int>(runs.size());
    const std::uint8_t* row = ink.row(y);
    for (int x = 0; x < ink.width();) {
      const std::uint8_t value = row[x];
      const int x0 = x;
      while (x < ink.width() && row[x] == value) ++x;
      if (value == kPaper) continue;
      const int self = static_cast<int>(runs.size());
      runs.push_back({y, x0, x - 1, self, 0, value});
      while (above < above_end && runs[at(above)].x1 < x0) ++above;
      for (int i = above; i < above_end && runs[at(i)].x0 < x; ++i)
        if (runs[at(i)].ink == value) join(runs, i, self);
    }
    above = start;
    above_end = static_cast<int>(runs.size());
  }
}

/// Sorts the runs by piece (counting sort); returns the number of pieces.
int sort_by_piece(LetterScratch& scratch) {
  const int count = static_cast<int>(scratch.runs.size());
  scratch.piece.resize(scratch.runs.size());
  int pieces = 0;
  for (int i = 0; i < count; ++i) {
    const int root = root_of(scratch.runs, i);
    scratch.piece[at(i)] = root == i ? pieces++ : scratch.piece[at(root)];
  }
  scratch.first.assign(at(pieces) + 1, 0);
  for (int i = 0; i < count; ++i) ++scratch.first[at(scratch.piece[at(i)]) + 1];
  for (std::size_t p = 0; p < at(pieces); ++p) scratch.first[p + 1] += scratch.first[p];
  scratch.order.resize(scratch.runs.size());
  std::vector<int>& place = scratch.distance;
  place.assign(scratch.first.begin(), scratch.first.end());
  for (int i = 0; i < count; ++i) scratch.order[at(place[at(scratch.piece[at(i)])]++)] = i;
  return pieces;
}

/// The runs of one piece, row by row, and their bounds.
struct Piece {
  const InkRun* runs;
  const int* order;
  int count;
  int x0, y0, x1, y1, area;

  const InkRun& operator[](int i) const { return runs[order[i]]; }
  int width() const { return x1 - x0 + 1; }
  int height() const { return y1 - y0 + 1; }
};

Piece piece_of(const LetterScratch& scratch, int p) {
  const int begin = scratch.first[at(p)], end = scratch.first[at(p) + 1];
  Piece piece{scratch.runs.data(), scratch.order.data() + begin, end - begin, 0, 0, 0, 0, 0};
  piece.x0 = piece[0].x0;
  piece.x1 = piece[0].x1;
  piece.y0 = piece[0].y;
  piece.y1 = piece[piece.count - 1].y;
  for (int i = 0; i < piece.count; ++i) {
    piece.x0 = std::min(piece.x0, piece[i].x0);
    piece.x1 = std::max(piece.x1, piece[i].x1);
    piece.area += piece[i].x1 - piece[i].x0 + 1;
  }
  return piece;
}

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
    const InkRun& run = piece[i];
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

/// Convex hull of the runs' corners. Runs come row by row, so each side is a chain that needs no sorting.
void trace_outline(const Piece& piece, std::vector<Point>& outline) {
  const auto turn = [](const Point& a, const Point& b, const Point& c) {
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
  };
  const auto extend = [&](std::size_t base, const Point& p) {
    while (outline.size() >= base + 2 && turn(outline[outline.size() - 2], outline.back(), p) <= 0) outline.pop_back();
    outline.push_back(p);
  };
  outline.clear();
  for (int i = 0; i < piece.count; ++i) {
    if (i + 1 < piece.count && piece[i + 1].y == piece[i].y) continue;
    for (const double half : {-0.5, 0.5}) extend(0, {piece[i].x1 + 0.5, piece[i].y + half});
  }
  const std::size_t base = outline.size();
  for (int i = piece.count - 1; i >= 0; --i) {
    if (i > 0 && piece[i - 1].y == piece[i].y) continue;
    for (const double half : {0.5, -0.5}) extend(base, {piece[i].x0 - 0.5, piece[i].y + half});
  }
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
  collect_runs(ink, scratch.runs);
  const int pieces = sort_by_piece(scratch);
  Letter letter;
  for (int p = 0; p < pieces; ++p) {
    if (scratch.first[at(p) + 1] - scratch.first[at(p)] < 2) continue;
    const Piece piece = piece_of(scratch, p);
    if (!has_letter_shape(piece, image, parameters)) continue;
    letter.light = piece[0].ink == kLightInk;
    letter.centre = {0.5 * (piece.x0 + piece.x1), 0.5 * (piece.y0 + piece.y1)};
    letter.size = std::max(piece.width(), piece.height());
    letter.area = piece.area;
    if (!measure_tones(piece, image, parameters, letter)) continue;
    if (!measure_stroke(piece, parameters, scratch.distance, letter)) continue;
    trace_outline(piece, letter.outline);
    letters.push_back(letter);
  }
}

}  // namespace textslam
