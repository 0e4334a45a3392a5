// Lens: what a camera model adds to a pinhole, in the one form that images behind a lens are worked on in.
//
// A ray m = (x/z, y/z), z > 0, goes to m_d = s(r^2) m + (2 p1 x y + p2 (r^2 + 2 x^2), p1 (r^2 + 2 y^2) + 2 p2 x y) with
// r = |m|, and the pixel is the pinhole's of m_d. Models differ in s alone.
#ifndef TEXTPLANE_CORE_CAMERAS_LENS_MAP_HPP
#define TEXTPLANE_CORE_CAMERAS_LENS_MAP_HPP

#include <cmath>
#include <type_traits>

#include "textplane/core/cameras/any_camera.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// s over a range of r^2: c[0] + t (c[1] + t (c[2] + ...)), t = r^2 - centre.
struct LensPiece {
  static constexpr int kMost = 15;  ///< Most coefficients.
  double low = 0;                   ///< The range begins.
  double high = 0;                  ///< It ends.
  double centre = 0;                ///< Where t is zero.
  int terms = 0;                    ///< Powers of t: 3, 6 or 14.
  double c[kMost] = {};             ///< Coefficients, c[0] to c[terms].

  /// s(r2).
  double at(double r2) const noexcept {
    double s = c[terms];
    for (int k = terms - 1; k >= 0; --k) s = s * (r2 - centre) + c[k];
    return s;
  }
};

/// The lens of one camera, in double. To make one takes a few hundred microseconds where s is no polynomial: it is
/// then cut into pieces that are.
TEXTPLANE_DEFERRED
class BasicLensMap {
 public:
  BasicLensMap() noexcept : BasicLensMap(AnyCamera<double>()) {}
  /// Of a camera model. A camera that is not valid() gives a lens that sees nothing: max_r2() is 0.
  explicit BasicLensMap(const AnyCamera<double>& camera) noexcept
      : camera_(camera), radial_(camera.visit([this](const auto& model) { return this->without_tangential(model); })) {
    if (!camera.valid()) return;
    set_end();
    set_pieces();
  }

  /// s(r2). If it is given, `rise` receives d (r s(r^2)) / d r.
  double radial(double r2, double* rise = nullptr) const noexcept {
    const double r = std::sqrt(r2);
    FixedMatrix<Real, 2, 2> J;
    const double distorted = radial_.distort({r, 0.0}, &J)[0];
    if (rise) *rise = J(0, 0);
    return r2 > 0 ? distorted / r : J(0, 0);
  }

  double p1() const noexcept { return p1_; }          ///< Tangential.
  double p2() const noexcept { return p2_; }          ///< Tangential.
  double max_r2() const noexcept { return max_r2_; }  ///< Rays of a larger r^2 have no pixel: the lens folds over.

  /// The shortest piece that holds s over [low, high], or null.
  const LensPiece* piece(double low, double high) const noexcept {
    for (int i = 0; i < count_; ++i)
      if (pieces_[i].low <= low && pieces_[i].high >= high) return &pieces_[i];
    return nullptr;
  }

  /// m_d of m. If J is given it receives d m_d / d m.
  Vector2<Real> distort(const Vector2<Real>& m, FixedMatrix<Real, 2, 2>* J = nullptr) const noexcept {
    return camera_.distort(m, J);
  }
  /// The same for any scalar.
  template <class S>
  Vector2<S> distort_as(const Vector2<S>& m) const noexcept {
    return camera_.template cast<S>().distort(m);
  }

  /// Inverse of distort(): the radial part by safeguarded Newton steps, then Newton's method for the rest, to 1e-12.
  /// Status::degenerate where no ray of the domain goes there, non_finite for NaN; then `m` is untouched.
  Status undistort(const Vector2<Real>& distorted, Vector2<Real>* m) const noexcept {
    if (!all_finite(distorted)) return Status::non_finite;
    if (!(max_r2_ > 0)) return Status::degenerate;
    const double size = std::sqrt(distorted.squaredNorm());
    double low = 0, high = std::sqrt(max_r2_), r = size < high ? size : high;
    for (int i = 0; i < 60; ++i) {
      double rise;
      const double e = r * radial(r * r, &rise) - size;
      (e > 0 ? high : low) = r;
      const double next = r - e / rise;
      if (!(std::abs(next - r) > 1e-15 * r)) break;
      r = next > low && next < high ? next : 0.5 * (low + high);
    }
    Vector2<Real> x = size > 0 ? Vector2<Real>(r / size * distorted) : Vector2<Real>(0, 0);
    for (int i = 0; i < 20; ++i) {
      FixedMatrix<Real, 2, 2> J;
      const Vector2<Real> e = distort(x, &J) - distorted;
      const double det = J(0, 0) * J(1, 1) - J(0, 1) * J(1, 0);
      if (!(det > 1e-9) || !all_finite(e)) return Status::degenerate;
      x[0] -= (J(1, 1) * e[0] - J(0, 1) * e[1]) / det;
      x[1] -= (J(0, 0) * e[1] - J(1, 0) * e[0]) / det;
      if (!(std::abs(e[0]) < 1e-12 && std::abs(e[1]) < 1e-12)) continue;
      if (!(x.squaredNorm() <= max_r2_)) return Status::degenerate;
      *m = x;
      return Status::ok;
    }
    return Status::degenerate;
  }

 private:
  // The same lens with no tangential part, which p1_ and p2_ keep.
  template <class Model>
  AnyCamera<double> without_tangential(Model model) noexcept {
    if constexpr (has_tangential<Model>::value) {
      p1_ = model.p1;
      p2_ = model.p2;
      model.p1 = model.p2 = 0;
    }
    return model;
  }
  template <class Model, class = void>
  struct has_tangential : std::false_type {};
  template <class Model>
  struct has_tangential<Model, std::void_t<decltype(Model::p1)>> : std::true_type {};

  // The first r where r s(r^2) stops rising, by steps and bisection; at most 80 degrees off the axis.
  void set_end() noexcept {
    const auto rises = [this](double r) {
      double rise;
      radial(r * r, &rise);
      return rise > 1e-6;
    };
    const double last = 5.67;
    double low = 0, high = 0;
    while (high < last && rises(high)) {
      low = high;
      high = high + 0.02 < last ? high + 0.02 : last;
    }
    if (rises(high)) low = high;
    for (int i = 0; i < 40 && low < high; ++i) {
      const double middle = 0.5 * (low + high);
      (rises(middle) ? low : high) = middle;
    }
    max_r2_ = low * low;
  }

  // Fills a piece with the interpolant of s at Chebyshev's points of [low, high]. False where it is off by more than
  // kTolerance of a ray between them.
  bool interpolate(double low, double high, int terms, LensPiece* out) const noexcept {
    double t[LensPiece::kMost] = {}, d[LensPiece::kMost] = {}, *p = out->c;
    const double middle = 0.5 * (low + high), half = 0.5 * (high - low);
    constexpr double kPi = 3.141592653589793;  // M_PI is not of the standard
    for (int i = 0; i <= terms; ++i) {
      t[i] = half * std::cos(kPi * (i + 0.5) / (terms + 1));
      d[i] = radial(middle + t[i]);
    }
    for (int order = 1; order <= terms; ++order)
      for (int i = terms; i >= order; --i) d[i] = (d[i] - d[i - 1]) / (t[i] - t[i - order]);
    for (int k = 0; k < LensPiece::kMost; ++k) p[k] = 0;
    p[0] = d[terms];
    for (int i = terms - 1; i >= 0; --i) {
      for (int k = terms; k > 0; --k) p[k] = p[k - 1] - t[i] * p[k];
      p[0] = d[i] - t[i] * p[0];
    }
    out->low = low;
    out->high = high;
    out->centre = middle;
    out->terms = terms;
    for (int k = 0; k <= 2 * terms + 2; ++k) {
      const double r2 = low + (high - low) * k / (2 * terms + 2);
      if (!(std::abs(out->at(r2) - radial(r2)) * std::sqrt(high) <= kTolerance)) return false;
    }
    return true;
  }

  // Pieces of so many terms that overlap by half, from the axis to the end.
  void add_pieces(int terms) noexcept {
    double low = 0;
    while (count_ < kMostPieces) {
      LensPiece piece;
      double high = max_r2_;
      if (!interpolate(low, high, terms, &piece)) {
        double bad = high, good = low;
        for (int i = 0; i < 12; ++i) {
          high = 0.5 * (good + bad);
          (interpolate(low, high, terms, &piece) ? good : bad) = high;
        }
        high = good;
        if (!(high > low) || !interpolate(low, high, terms, &piece)) return;
      }
      pieces_[count_++] = piece;
      if (high >= max_r2_) return;
      low = 0.5 * (low + high);
    }
  }
  void set_pieces() noexcept {
    count_ = 0;
    if (!(max_r2_ > 0)) return;
    if (interpolate(0, max_r2_, 3, &pieces_[0])) {
      count_ = 1;
      return;
    }
    add_pieces(6);
    add_pieces(LensPiece::kMost - 1);
  }

  static constexpr double kTolerance = 2e-9;  // 1e-6 px at a focal length of 500 px
  static constexpr int kMostPieces = 40;

  AnyCamera<double> camera_;
  double p1_ = 0, p2_ = 0;
  AnyCamera<double> radial_;  // sets p1_ and p2_
  double max_r2_ = 0;
  LensPiece pieces_[kMostPieces];
  int count_ = 0;
};
using LensMap = BasicLensMap<>;  ///< It is compiled only where it is used.

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_CORE_CAMERAS_LENS_MAP_HPP
