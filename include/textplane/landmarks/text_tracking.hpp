// TextTracking: what the mapped texts in view make of the pose of a frame, and when the host's own stays.
#ifndef TEXTPLANE_LANDMARKS_TEXT_TRACKING_HPP
#define TEXTPLANE_LANDMARKS_TEXT_TRACKING_HPP

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "textplane/landmarks/text_bounds.hpp"
#include "textplane/landmarks/text_mapping.hpp"
#include "textplane/landmarks/text_pose.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// Why a text took part in a pose, or did not.
enum class TextUse : std::uint8_t {
  used,        ///< It took part.
  dissimilar,  ///< The image does not look like it, where it should be: hidden, blurred, or the pose is far off.
  disagrees,   ///< What it says of the pose contradicts the points or the other texts.
};

/// What one text in view did.
struct TextReport {
  int id = -1;                  ///< Of the object.
  TextUse use = TextUse::used;  ///< Whether it took part.
  double zncc = 0;              ///< At the pose returned.
  double share = 0;             ///< Of the information on the camera's position.
};

/// Result of TextMap::track().
struct TextFit {
  SE3d T_c_w;            ///< World to camera: refined, or the host's own to the bit.
  bool refined = false;  ///< Which of the two.
  FixedMatrix<double, 6, 6> information = FixedMatrix<double, 6, 6>::Zero();  ///< Of T_c_w, xi = (v, omega) left.
  double gain = 0;   ///< By how much the texts lower the standard deviation of the camera's position, as a share.
  double drift = 1;  ///< Factor of the points' standard deviations: by so much more than their residuals they err.
  int texts = 0;     ///< Texts that took part.
  Status status = Status::invalid_argument;  ///< ok; diverged: texts and points disagree; else too_few.
  std::vector<TextReport> reports;           ///< Of the mapped texts in view.
};

/// Settings of a TextMap.
struct TextMapOptions {
  TextOptions text;           ///< Of the life of a text.
  double min_zncc = 0.6;      ///< Of a text that takes part in a pose.
  double near_zncc = 0.9;     ///< Where all texts in view begin with it, coarser levels are not asked.
  double least_gain = 0.1;    ///< Of TextFit::gain; with less the host's pose stays as it is.
  double least_sigma = 0.25;  ///< px: points are not taken to be better.
  double most_shift = 2;      ///< Factor by which texts may raise the scale of the points' residuals.
  /// Standard deviations by which a text may disagree with all the rest at full weight: by chance, one of twenty
  /// disagrees by more, of those that determine four degrees of freedom.
  double text_huber = 1.5;
  double most_disagreement = 4;  ///< The same: one that disagrees by more does not take part.
  int drift_frames = 32;  ///< Of the mean that TextFit::drift is: a drift is slow, and what one frame says is noise.
  int max_images = 100;   ///< Key frames whose images are kept; of older ones the poses stay where texts need them.
};

/// Tracks the texts of a TextMap; keeps its memory. For one thread at a time.
TEXTPLANE_DEFERRED
class BasicTextTracking {
 public:
  /// All must outlive it.
  BasicTextTracking(const TextMapOptions& options, const TextMapping& mapping, const TextBounds& bounds)
      : options_(options), mapping_(mapping), bounds_(bounds) {}

  /// As TextMap::track().
  const TextFit& track(const TextImage& image, const SE3d& T_c_w, const std::vector<TextPoint>& points);

  double point_scale() const noexcept { return point_scale_; }  ///< As TextMap has it.

  /// Of each text that took part or disagreed since the last forget_conflicts(), by increasing id.
  const std::vector<TextConflict>& conflicts() const noexcept { return conflicts_; }
  void forget_conflicts() noexcept { conflicts_.clear(); }  ///< Begins to count anew.

 private:
  // No result yet, in the memory of the last one.
  TextFit& begin_fit(const SE3d& T_c_w) {
    TextFit fresh;
    fresh.T_c_w = T_c_w;
    fresh.reports.swap(fit_.reports);
    fresh.reports.clear();
    fit_ = std::move(fresh);
    return fit_;
  }

  // The pose by the points and the texts that look right and agree, and what each text did. False where they do not
  // determine it.
  bool solve_together(const TextImage& image, double scale, SE3d* both, TextFit& fit) {
    for (FrameText& text : visible_) text.used = text.zncc >= options_.min_zncc;
    bool ok = pose_.solve(points_, scale, visible_, image, both);
    if (ok) learn_drift();
    bool changed = false;
    for (FrameText& text : visible_) {
      const bool good = text.used && text.zncc >= options_.min_zncc;
      changed |= good != text.used;
      text.used = good;
    }
    if (ok && changed) ok = pose_.solve(points_, scale, visible_, image, both);
    for (const FrameText& text : visible_)
      fit.reports.push_back({text.object->id, text.used ? TextUse::used : TextUse::dissimilar, 0, 0});
    for (int round = 0; round < kRounds && ok; ++round) {
      if (!pose_.weigh(visible_, options_.text_huber, options_.most_disagreement)) break;
      ok = pose_.solve(points_, scale, visible_, image, both);
    }
    for (std::size_t i = 0; i < visible_.size(); ++i) {
      const FrameText& text = visible_[i];
      TextReport& report = fit.reports[i];
      fit.texts += text.used ? 1 : 0;
      report.zncc = text.zncc;
      report.share = text.share;
      if (report.use == TextUse::dissimilar) continue;
      if (!text.used) report.use = TextUse::disagrees;
      if (ok) count(report.id, !text.used);
    }
    return ok;
  }

  // After a solve by all texts that look right, and by points that are trusted as drift() says.
  void learn_drift() noexcept {
    const double f = points_.size() >= TextPose::kFewestPoints ? pose_.point_doubt(visible_, drift() * drift()) : 0;
    if (f > 0) doubt_ += (f - doubt_) / (std::max)(options_.drift_frames, 1);
  }
  // One text alone has no other to vouch for it.
  double drift() const noexcept { return visible_.size() > 1 ? std::sqrt(doubt_) : 1; }

  // Of a text that was compared in this frame.
  void count(int id, bool disagrees) {
    const auto at = std::lower_bound(conflicts_.begin(), conflicts_.end(), id,
                                     [](const TextConflict& one, int wanted) { return one.id < wanted; });
    const int change = disagrees ? 1 : -1;
    if (at != conflicts_.end() && at->id == id) {
      at->balance += change;
    } else {
      conflicts_.insert(at, {id, change});
    }
  }

  void find_visible(const TextImage& image, const SE3d& T_c_w) {
    visible_.clear();
    bounds_.for_each_near(image, T_c_w, [&](std::size_t i, const SE3d& T_w_h) {
      const TextObject& text = mapping_.objects()[i];
      Quad<double> quad;
      if (text_in_view(options_.text, text, T_c_w * T_w_h, image, &quad))
        visible_.push_back({&text, T_w_h, scale_shift(text, quad)});
    });
  }

  // Coarse to fine, into the texts' basins: no further, TextPose goes on from there. Returns how many texts look right.
  int approach(const TextImage& image, double scale, bool with_points, SE3d* T_c_w) {
    terms_.clear();
    for (const FrameText& text : visible_)
      terms_.push_back(
          {&text.object->patch, text.object->theta, text.T_w_h, 1 / text.object->variance_factor, text.scale_shift});
    const int n = static_cast<int>(terms_.size()), m = with_points ? static_cast<int>(points_.size()) : 0;
    workspace_.reserve(terms_.data(), n, m);
    zncc_.assign(visible_.size(), -1.0F);
    PoseOptions pose;
    pose.sigma_rep = scale;
    pose.solve.cost_tolerance = 1e-3;
    const PoseFit fit = refine_pose(terms_.data(), n, points_.data(), m, image.pyramid, image.camera, *T_c_w, pose,
                                    workspace_, zncc_.data(), nullptr);
    if (is_ok(fit.status)) *T_c_w = renormalised(fit.T_t_w);
    return static_cast<int>(std::count_if(
        zncc_.begin(), zncc_.end(), [this](float zncc) { return static_cast<double>(zncc) >= options_.min_zncc; }));
  }

  // approach() from where most texts come into their basins. Few points may lead far off: where they leave half of the
  // texts or more without a match, texts try without them, and from where the frame before was.
  SE3d find_basin(const TextImage& image, double scale, const SE3d& host, const SE3d& by_points) {
    const struct {
      const SE3d& T_c_w;
      bool with_points;
    } starts[] = {{by_points, true}, {host, false}, {by_points, false}, {last_, true}, {last_, false}};
    SE3d best;
    int most = -1;
    for (const auto& start : starts) {
      if (2 * most > static_cast<int>(visible_.size())) break;
      if (points_.empty() && !start.with_points) continue;  // it was tried: without points both are one
      SE3d T_c_w = start.T_c_w;
      const int similar = approach(image, scale, start.with_points, &T_c_w);
      if (similar <= most) continue;
      most = similar;
      best = T_c_w;
    }
    pose_.judge(visible_, image, best);
    return best;
  }

  static constexpr int kRounds = 5;  // of weighing the texts by their agreement; each may leave one out

  const TextMapOptions& options_;
  const TextMapping& mapping_;
  const TextBounds& bounds_;
  TextPose pose_;
  double point_scale_ = 1, doubt_ = 1;
  TextFit fit_;
  SE3d last_;  // where the last frame's texts were looked for
  PoseWorkspace workspace_;
  std::vector<PosePointTerm> points_;
  std::vector<PoseTextTerm> terms_;
  std::vector<FrameText> visible_;
  std::vector<float> zncc_;
  std::vector<TextConflict> conflicts_;
};
using TextTracking = BasicTextTracking<>;  ///< It is compiled only where it is used.

template <class Real>
const TextFit& BasicTextTracking<Real>::track(const TextImage& image, const SE3d& T_c_w,
                                              const std::vector<TextPoint>& points) {
  TextFit& fit = begin_fit(T_c_w);
  if (!all_finite(T_c_w) || image.pyramid.levels < 1 || !image.camera.valid()) return fit;
  points_.clear();
  for (const TextPoint& point : points)
    if (point.has_position && all_finite(point.p_w) && all_finite(point.px) && point.sigma > 0)
      points_.push_back({point.p_w, point.px, point.sigma});
  find_visible(image, T_c_w);
  fit.status = Status::too_few;
  if (visible_.empty()) return fit;

  // What the points say alone.
  const double residuals = pose_.point_scale(points_, image.camera, T_c_w, options_.least_sigma);
  if (points_.size() >= TextPose::kFewestPoints) point_scale_ = residuals;
  fit.drift = drift();
  const double scale = fit.drift * residuals;
  SE3d by_points = T_c_w;
  const bool has_points = points_.size() >= 6 && pose_.solve(points_, scale, visible_, image, &by_points);
  if (!has_points) by_points = T_c_w;
  const double alone = has_points ? position_sigma(pose_.information()) : 0;

  SE3d both = by_points;
  if (pose_.judge(visible_, image, both) < options_.near_zncc) both = find_basin(image, scale, T_c_w, by_points);
  last_ = both;
  const bool ok = solve_together(image, scale, &both, fit);
  if (!ok || fit.texts == 0) {
    if (std::any_of(fit.reports.begin(), fit.reports.end(), [](const auto& r) { return r.use == TextUse::disagrees; }))
      fit.status = Status::diverged;
    fit.texts = 0;
    return fit;
  }
  fit.gain = has_points ? 1 - position_sigma(pose_.information()) / alone : 1;
  const bool most_fit = 2 * fit.texts >= static_cast<int>(visible_.size());
  if (fit.gain < options_.least_gain || (has_points && !most_fit)) return fit;
  if (has_points &&
      pose_.point_scale(points_, image.camera, both, options_.least_sigma) > options_.most_shift * scale) {
    for (TextReport& report : fit.reports)
      if (report.use == TextUse::used) report.use = TextUse::disagrees;
    fit.status = Status::diverged;
    fit.texts = 0;
    return fit;
  }
  fit.T_c_w = last_ = both;
  fit.information = pose_.information();
  fit.refined = true;
  fit.status = Status::ok;
  return fit;
}

TEXTPLANE_INSTANCE(class BasicTextTracking<double>);

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_LANDMARKS_TEXT_TRACKING_HPP
