// Pieces: the connected pieces of an image of few classes, as runs of pixels, and their convex hulls.
#ifndef TEXTSLAM_DETECTORS_PIECES_HPP
#define TEXTSLAM_DETECTORS_PIECES_HPP

#include <cstddef>
#include <cstdint>
#include <vector>

#include "io/names.hpp"

namespace textslam {

inline std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// A stretch of one class in one row, x0 to x1 inclusive.
struct PixelRun {
  int y, x0, x1;
  int parent;  ///< union-find over runs; a root is the first run of its piece
  int joints;  ///< of a root: pairs of runs of its piece that touch
  std::uint8_t value;
};

/// The runs of one piece, row by row, and their bounds. Good until its Pieces find others.
struct Piece {
  const PixelRun* runs;
  const int* order;
  int count;
  int x0, y0, x1, y1, area;

  const PixelRun& operator[](int i) const { return runs[order[i]]; }
  int width() const { return x1 - x0 + 1; }
  int height() const { return y1 - y0 + 1; }
};

/// What pixels of neighbouring rows touch: those that share a side, or a corner too.
enum class Touch { sides, corners };

class Pieces {
 public:
  /// Of the classes other than 0. Pieces are in the order of their first pixels.
  void find(const ImageView8& classes, Touch touch);
  int size() const { return pieces_; }
  /// How many runs piece `p` has.
  int runs_of(int p) const { return first_[at(p) + 1] - first_[at(p)]; }
  Piece operator[](int p) const;

 private:
  std::vector<PixelRun> runs_;
  std::vector<int> piece_, first_, order_, place_;  // of runs: their piece; of pieces: where their runs start in order_
  int pieces_ = 0;
};

/// Convex hull, clockwise on the screen: of the pixels' squares (`half` = 0.5 px) or of their centres (0).
void trace_outline(const Piece& piece, double half, std::vector<Vector2<double>>& outline);

}  // namespace textslam

#endif  // TEXTSLAM_DETECTORS_PIECES_HPP
