#include "planar/trials.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <functional>

#include "io/image_codecs.hpp"
#include "io/image_file.hpp"
#include "io/input_error.hpp"
#include "planar/peers.hpp"
#include "planar/plane_video.hpp"
#include "renderer/random.hpp"

namespace planar {

namespace {
using textslam::InputError;
using Matrix = tp::Matrix3<double>;

constexpr double kSuccess = 1.0;  // px

/// The pose and plane that map four corners of the host to four of the target. Converges from a homography near one of
/// a camera.
class CornerProblem {
 public:
  using State = PlaneState;
  static constexpr int kParameters = 9;
  struct System {
    Eigen::Matrix<double, 9, 9> H = 1e-9 * Eigen::Matrix<double, 9, 9>::Identity();  // scale is free
    Eigen::Matrix<double, 9, 1> b = Eigen::Matrix<double, 9, 1>::Zero();
    double cost = 0;
    tp::Status status = tp::Status::ok;
  };

  CornerProblem(const tp::Quad<double>& from, const tp::Quad<double>& to, const tp::Pinhole<double>& camera)
      : from_(from), to_(to), camera_(camera) {}

  System linearise(const State& x) noexcept {
    System out;
    for (std::size_t i = 0; i < 4; ++i) {
      tp::Vector2<double> m;
      tp::WarpJacobians<double> J;
      out.status = tp::warp_point(x.theta, x.T_t_h, camera_.unproject(from_.corner[i]), &m, &J);
      if (!tp::is_ok(out.status)) return out;
      Eigen::Matrix<double, 2, 9> rows;
      rows << J.pose, J.theta;
      rows *= camera_.fx;
      const tp::Vector2<double> r = camera_.pixel(m) - to_.corner[i];
      out.H += rows.transpose() * rows;
      out.b += rows.transpose() * r;
      out.cost += r.squaredNorm();
    }
    return out;
  }
  tp::Evaluation evaluate(const State& x) noexcept {
    const System s = linearise(x);
    return {s.cost, 0, s.status};
  }
  State retract(const State& x, const Eigen::Matrix<double, 9, 1>& step) const noexcept {
    return {tp::se3_exp<double>(step.head<6>()) * x.T_t_h, x.theta + step.tail<3>()};
  }

 private:
  const tp::Quad<double>& from_;
  const tp::Quad<double>& to_;
  const tp::Pinhole<double>& camera_;
};

/// `state` turned, shifted and scaled at random. Its corners move by `offset` px on average.
PlaneState perturbed(const PlaneTracker& tracker, const PlaneState& state, double offset, textslam::Random& random) {
  const tp::Quad<double> there = tracker.quad(state);
  const double reach = tracker.camera().fx / (0.5 * (there.corner[0] - there.corner[2]).norm());
  tp::Vector6<double> xi;
  for (int k = 0; k < 6; ++k) xi[k] = (k % 3 == 2 ? reach : 1.0) * random.normal();
  xi *= 1e-3;
  PlaneState out = state;
  for (int k = 0; k < 20; ++k) {
    out.T_t_h = tp::se3_exp(xi) * state.T_t_h;
    xi *= offset / corner_error(tracker.quad(out), there);
  }
  return out;
}

/// Upright rectangles of a word's size at random places with as many corners as text has.
std::vector<tp::Quad<double>> random_quads(const textslam::Image<std::uint8_t>& image, int count,
                                           textslam::Random& random) {
  constexpr double kWidth = 120, kHeight = 40;
  constexpr int kThreshold = 20;
  constexpr std::size_t kCorners = 60;
  std::vector<tp::Corner> corners;
  tp::detect_fast(image.view(), kThreshold, true, corners);
  std::vector<tp::Quad<double>> out;
  for (int tries = 0; tries < 100 * count && static_cast<int>(out.size()) < count; ++tries) {
    const double x = random.uniform(kBorder, image.width() - kBorder - kWidth);
    const double y = random.uniform(kBorder, image.height() - kBorder - kHeight);
    tp::Quad<double> q;
    q.corner = {tp::Vector2<double>(x, y), tp::Vector2<double>(x + kWidth, y),
                tp::Vector2<double>(x + kWidth, y + kHeight), tp::Vector2<double>(x, y + kHeight)};
    const auto inside = std::count_if(corners.begin(), corners.end(), [&q](const tp::Corner& c) {
      return tp::contains(q, tp::Vector2<double>(c.x, c.y));
    });
    if (static_cast<std::size_t>(inside) >= kCorners) out.push_back(q);
  }
  return out;
}

/// The levels of a pyramid by local contrast, each on its own.
class LocalLevels {
 public:
  explicit LocalLevels(const tp::PyramidView& from) {
    view_.levels = from.levels;
    for (std::size_t l = 0; l < static_cast<std::size_t>(from.levels); ++l) {
      levels_.emplace_back(from.level[l].width(), from.level[l].height());
      tp::LocalContrast(AppearanceOptions().contrast)(from.level[l], 0, 0, levels_.back().view());
      view_.level[l] = tp::ImageView8(levels_.back().view());
    }
  }
  const tp::PyramidView& view() const noexcept { return view_; }

 private:
  std::vector<tp::Image<std::uint8_t>> levels_;  // moving them keeps their pixels in place
  tp::PyramidView view_;
};

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// A PhotoSet with its pixels, and the quads that trials start from.
struct Photos {
  textslam::Image<std::uint8_t> first;
  tp::Pyramid first_pyramid;
  std::vector<tp::Pyramid> others;
  std::vector<LocalLevels> local;  ///< of the first, then of the others
  std::vector<tp::Quad<double>> quads;
};

Photos load_photos(const PhotoSet& set, int count, textslam::Random& random) {
  const int levels = PlaneTrackerOptions().select.levels;
  Photos p;
  p.first = textslam::load_grey(set.first);
  p.first_pyramid.build(p.first.view(), levels);
  p.local.emplace_back(p.first_pyramid.view());
  for (std::size_t i = 0; i < set.others.size(); ++i) {
    textslam::Image<std::uint8_t> image = textslam::load_grey(set.others[i]);
    if (!set.jpeg.empty()) {
      const std::string bytes = textslam::encode_jpeg(image.view(), set.jpeg[i]);
      image = textslam::decode_jpeg(bytes, set.others[i]);
    }
    p.others.emplace_back(image.view(), levels);
    p.local.emplace_back(p.others.back().view());
  }
  p.quads = set.text ? text_quads(p.first, set.not_text) : random_quads(p.first, count, random);
  return p;
}

/// A quad of photos.first, its true place in photograph `other`, and where the aligners start.
struct Trial {
  const Photos& photos;
  std::size_t other;
  const tp::Quad<double>& quad;
  const tp::Quad<double>& truth;
  const PlaneState& start;
};

/// Runs all aligners and counts their successes. Times are kept of starts that are `off`.
void run_trial(const Trial& t, bool off, PlaneTracker& tracker, std::vector<Score>& scores,
               std::vector<std::vector<double>>& times) {
  const Photos& p = t.photos;
  const tp::Pyramid& other = p.others[t.other];
  const tp::Pinhole<double>& camera = tracker.camera();
  const Matrix H = tp::pixel_homography(tp::plane_homography(t.start.theta, t.start.T_t_h), camera, camera);
  PlaneState state = t.start;
  Matrix ecc = H, local = H, ssd = H;
  const std::function<bool()> align[] = {
      [&] { return tp::is_ok(tracker.align(other, state)); },
      [&] { return align_ecc(p.first_pyramid, t.quad, other, &ecc); },
      [&] { return align_ecc(p.local[0].view(), t.quad, p.local[t.other + 1].view(), &local); },
      [&] { return align_ssd(tracker.patch(), other, &ssd); }};
  for (std::size_t k = 0; k < scores.size(); ++k) {
    const std::clock_t begin = std::clock();
    const bool ok = align[k]();
    if (off) times[k].push_back(1e3 * static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
    tp::Quad<double> found = tracker.quad(state);
    if (!ok || (k > 0 && !tp::is_ok(tp::transform(t.quad, k == 1 ? ecc : k == 2 ? local : ssd, &found)))) continue;
    if (corner_error(found, t.truth) < kSuccess) ++(off ? scores[k].successes : scores[k].from_truth);
  }
}

}  // namespace

Trials run_trials(const std::vector<PhotoSet>& sets, int count, double offset, std::uint64_t seed) {
  Trials out;
  textslam::Random random(seed);
  std::vector<Photos> photos;
  for (const PhotoSet& set : sets) {
    photos.push_back(load_photos(set, count, random));
    out.quads += static_cast<int>(photos.back().quads.size());
  }
  if (out.quads == 0) throw InputError(sets.front().first, 0, "no text found");

  for (const char* name : {"textplane", "ECC", "ECC, local contrast", "SSD"}) out.scores.push_back({name, 0, 0, 0});
  std::vector<std::vector<double>> times(out.scores.size());
  while (out.count < count) {
    const auto s = static_cast<std::size_t>(random.below(static_cast<int>(sets.size())));
    const Photos& p = photos[s];
    if (p.quads.empty()) continue;
    const tp::Quad<double>& quad = p.quads[static_cast<std::size_t>(random.below(static_cast<int>(p.quads.size())))];
    const auto o = static_cast<std::size_t>(random.below(static_cast<int>(p.others.size())));
    PlaneTracker tracker(p.first.view(), quad);
    tp::Quad<double> truth;
    if (!tp::is_ok(tracker.status()) || !tp::is_ok(tp::transform(quad, sets[s].truth[o], &truth))) continue;
    if (!tp::inside_image(truth, p.others[o].level(0).width(), p.others[o].level(0).height(), kBorder)) continue;
    CornerProblem corners(quad, truth, tracker.camera());
    PlaneState exact;
    tp::SolveOptions solve;
    solve.max_iterations = 100;
    tp::minimise(corners, exact, solve);
    if (corner_error(tracker.quad(exact), truth) > 0.01) continue;
    ++out.count;
    const PlaneState start = perturbed(tracker, exact, offset, random);
    run_trial({p, o, quad, truth, start}, true, tracker, out.scores, times);
    run_trial({p, o, quad, truth, exact}, false, tracker, out.scores, times);
  }
  for (std::size_t k = 0; k < times.size(); ++k) out.scores[k].milliseconds = median(times[k]);
  return out;
}

}  // namespace planar
