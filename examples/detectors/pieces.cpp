#include "detectors/pieces.hpp"

#include <algorithm>

namespace textslam {
namespace {

int root_of(std::vector<PixelRun>& runs, int i) {
  while (runs[at(i)].parent != i) {
    runs[at(i)].parent = runs[at(runs[at(i)].parent)].parent;
    i = runs[at(i)].parent;
  }
  return i;
}

/// Runs a and b touch. The earlier root stays, so that results do not depend on the order of joins.
void join(std::vector<PixelRun>& runs, int a, int b) {
  const int i = root_of(runs, a), j = root_of(runs, b);
  const int low = std::min(i, j), high = std::max(i, j);
  if (low != high) {
    runs[at(high)].parent = low;
    runs[at(low)].joints += runs[at(high)].joints;
  }
  ++runs[at(low)].joints;
}

/// `reach`: how many columns apart runs of neighbouring rows touch.
void collect_runs(const ImageView8& classes, int reach, std::vector<PixelRun>& runs) {
  runs.clear();
  int above = 0, above_end = 0;
  for (int y = 0; y < classes.height(); ++y) {
    const int start = static_cast<int>(runs.size());
    const std::uint8_t* row = classes.row(y);
    for (int x = 0; x < classes.width();) {
      const std::uint8_t value = row[x];
      const int x0 = x;
      while (x < classes.width() && row[x] == value) ++x;
      if (value == 0) continue;
      const int self = static_cast<int>(runs.size());
      runs.push_back({y, x0, x - 1, self, 0, value});
      while (above < above_end && runs[at(above)].x1 < x0 - reach) ++above;
      for (int i = above; i < above_end && runs[at(i)].x0 < x + reach; ++i)
        if (runs[at(i)].value == value) join(runs, i, self);
    }
    above = start;
    above_end = static_cast<int>(runs.size());
  }
}

}  // namespace

void Pieces::find(const ImageView8& classes, Touch touch) {
  collect_runs(classes, touch == Touch::corners ? 1 : 0, runs_);
  const int count = static_cast<int>(runs_.size());
  pieces_ = 0;
  piece_.resize(runs_.size());
  for (int i = 0; i < count; ++i) {
    const int root = root_of(runs_, i);
    piece_[at(i)] = root == i ? pieces_++ : piece_[at(root)];
  }
  // Counting sort by piece.
  first_.assign(at(pieces_) + 1, 0);
  for (int i = 0; i < count; ++i) ++first_[at(piece_[at(i)]) + 1];
  for (std::size_t p = 0; p < at(pieces_); ++p) first_[p + 1] += first_[p];
  order_.resize(runs_.size());
  place_.assign(first_.begin(), first_.end());
  for (int i = 0; i < count; ++i) order_[at(place_[at(piece_[at(i)])]++)] = i;
}

Piece Pieces::operator[](int p) const {
  Piece piece{runs_.data(), order_.data() + first_[at(p)], runs_of(p), 0, 0, 0, 0, 0};
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

// Runs come row by row, so each side is a chain that needs no sorting.
void trace_outline(const Piece& piece, double half, std::vector<Vector2<double>>& outline) {
  const auto turn = [](const Vector2<double>& a, const Vector2<double>& b, const Vector2<double>& c) {
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
  };
  const auto extend = [&](std::size_t base, const Vector2<double>& p) {
    while (outline.size() >= base + 2 && turn(outline[outline.size() - 2], outline.back(), p) <= 0) outline.pop_back();
    outline.push_back(p);
  };
  outline.clear();
  for (int i = 0; i < piece.count; ++i) {
    if (i + 1 < piece.count && piece[i + 1].y == piece[i].y) continue;
    for (const double side : {-half, half}) extend(0, {piece[i].x1 + half, piece[i].y + side});
  }
  const std::size_t base = outline.size();
  for (int i = piece.count - 1; i >= 0; --i) {
    if (i > 0 && piece[i - 1].y == piece[i].y) continue;
    for (const double side : {half, -half}) extend(base, {piece[i].x0 - half, piece[i].y + side});
  }
}

}  // namespace textslam
