// A TextMap under any calls in any order. What holds whatever a host does: nothing crashes or throws, ids of objects
// increase and are not used twice, states only advance, planes and covariances are finite, a pose that was not refined
// is the host's to the bit, and no more images are kept than asked for.
#include <cmath>
#include <cstring>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "fuzz.hpp"
#include "textplane/landmarks/text_map.hpp"

namespace textplane_fuzz {
namespace {

constexpr int kWidth = 80, kHeight = 60, kMostCalls = 24;
constexpr double kDepth = 2;  // of the wall

// A wall of blocks of random grey before the camera, so that quads on it become texts.
double wall(double x, double y) {
  const auto block = [](double at) {
    return static_cast<std::uint32_t>(static_cast<std::int32_t>(std::floor(at * 9)));
  };
  const std::uint32_t hash = (block(x) * 2654435761U) ^ (block(y) * 2246822519U);
  return 30 + static_cast<double>((hash ^ hash >> 15) * 2654435761U >> 24) * 0.8;
}

tp::Pyramid seen_from(const tp::SE3d& T_c_w, const tp::Pinhole<double>& camera, int width, int height) {
  std::vector<std::uint8_t> pixels(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 128);
  const tp::SE3d T_w_c = T_c_w.inverse();
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const tp::Vector3<double> ray = T_w_c.R * camera.unproject({x, y});
      if (ray.z() == 0) continue;
      const tp::Vector3<double> at = T_w_c.t + (kDepth - T_w_c.t.z()) / ray.z() * ray;
      if (std::abs(at.x()) < 1e6 && std::abs(at.y()) < 1e6)
        pixels[static_cast<std::size_t>(y * width + x)] = static_cast<std::uint8_t>(wall(at.x(), at.y()));
    }
  return tp::Pyramid(tp::ImageView8(pixels.data(), width, height), 3);
}

bool same_bits(const tp::SE3d& a, const tp::SE3d& b) {
  return std::memcmp(a.R.data(), b.R.data(), 9 * sizeof(double)) == 0 &&
         std::memcmp(a.t.data(), b.t.data(), 3 * sizeof(double)) == 0;
}

template <int N>
bool is_covariance(const tp::FixedMatrix<double, N, N>& C) {
  const double size = C.cwiseAbs().maxCoeff();
  if (!tp::all_finite(C) || !((C - C.transpose()).cwiseAbs().maxCoeff() <= 1e-9 * size)) return false;
  for (int i = 0; i < N; ++i)
    if (!(C(i, i) >= 0)) return false;
  if (!(size > 1e-150 && size < 1e150)) return true;  // what follows squares it
  return tp::symmetric_eigen<double, N>(0.5 / size * (C + C.transpose())).values[0] >= -1e-9;
}

tp::TextMapOptions options_of(Input& in) {
  tp::TextMapOptions options;
  tp::TextOptions& text = options.text;
  text.min_area = 40;
  text.min_pixels = 5;
  text.max_pixels = 60;
  text.refine_pixels = 100;
  text.border = 1;
  text.min_observations = in.integer(1, 4);
  text.min_detections = in.integer(1, 3);
  text.patience = in.integer(1, 25);
  text.refine_max_sigma = 40;
  text.least_expected_zncc = 0.3;
  text.min_zncc = 0.5;
  options.max_images = in.integer(-1, 12);
  options.least_gain = in.tame(-1, 0.3);
  // clang-format off
  double* const reals[] = {
      &text.overlap, &text.min_area, &text.confirm_iou, &text.min_parallax, &text.plane_outlier, &text.detected_share,
      &text.min_zncc, &text.cull_zncc, &text.max_slant, &text.seen_border, &text.seen_area, &text.min_share,
      &text.clear_noise, &text.rehost_area, &text.rehost_slant, &text.refine_area, &text.refine_scale,
      &text.refine_margin, &text.blur_variance, &text.blur_spread, &text.refine_most_bend, &text.same_word,
      &text.refine_max_sigma, &text.merge_angle, &text.merge_depth, &text.merge_sigmas, &text.merge_overlap,
      &options.min_zncc, &options.least_sigma, &options.most_shift, &options.least_gain, &text.plane_min_error,
      &options.text_huber, &options.most_disagreement};
  // clang-format on
  int* const integers[] = {&text.min_pixels,         &text.levels,        &text.min_corners,    &text.plane_rounds,
                           &text.min_observations,   &text.views,         &text.max_failures,   &text.refine_hosts,
                           &text.refine_views,       &text.refine_pixels, &text.refine_reach,   &text.max_readings,
                           &text.tentative_patience, &text.max_pixels,    &options.drift_frames};
  for (int changes = in.integer(0, 7) - 4; changes > 0; --changes) {
    *reals[in.integer(0, 33)] = in.number(-1, 4);
    *integers[in.integer(0, 14)] = in.integer(-2, 20);
  }
  return options;
}

class Host {
 public:
  explicit Host(Input& in)
      : in_(in),
        options_(options_of(in)),
        map_(in.integer(0, 15) == 0 ? in.camera(kWidth, kHeight) : camera_, options_) {}

  void run() {
    for (int i = 0; i < kMostCalls && !in_.empty(); ++i) {
      call(in_.integer(0, 15));
      check();
    }
  }

 private:
  void call(int what) {
    if (what < 4) return track();
    if (what < 13) return add(what - 4);
    if (what == 13) return move();
    if (what == 14) return remove(any_id());
    const tp::TextObject stranger;
    std::array<tp::Vector3<double>, 4> corners;
    TEXTPLANE_FUZZ_REQUIRE(!map_.corners(stranger, &corners));
  }

  // Mostly along the wall; seldom anywhere, or no rigid motion at all.
  tp::SE3d pose() {
    const int kind = in_.integer(0, 15);
    if (kind == 0) return in_.pose(3, 3);
    tp::SE3d T = {
        tp::so3_exp<double>(tp::Vector3<double>(in_.tame(-0.1, 0.1), in_.tame(-0.1, 0.1), in_.tame(-0.1, 0.1))),
        {in_.tame(-0.6, 0.6), in_.tame(-0.3, 0.3), in_.tame(-0.7, 0.5)}};
    if (kind == 1) T.R *= in_.number(0, 2);
    return T;
  }
  int any_id() { return in_.integer(0, 31) == 0 ? (in_.flag() ? 2147483647 : -2147483647 - 1) : in_.integer(-2, 13); }
  tp::Pyramid image(const tp::SE3d& T_c_w) {
    const int kind = in_.integer(0, 31);
    if (kind == 0) return {};
    if (kind == 1) return tp::Pyramid(FuzzImage(in_, 1, 40).view(), in_.integer(0, 9));
    return seen_from(T_c_w, camera_, kWidth, kHeight);
  }
  tp::Vector3<double> on_wall() { return {in_.tame(-0.8, 0.8), in_.tame(-0.6, 0.6), kDepth}; }

  std::vector<tp::TextDetection> quads(const tp::SE3d& T_c_w) {
    std::vector<tp::TextDetection> found;
    for (int i = in_.integer(0, 4); i > 0; --i) {
      tp::TextDetection seen;
      const int kind = in_.integer(0, 15), sign = in_.integer(0, 2);
      const double x = -0.6 + 0.5 * sign, y = -0.3 + 0.2 * sign;
      const double corners[4][2] = {{x, y}, {x + 0.4, y}, {x + 0.4, y + 0.25}, {x, y + 0.25}};
      for (std::size_t k = 0; k < 4; ++k)
        seen.quad.corner[k] = camera_.project(T_c_w * tp::Vector3<double>(corners[k][0], corners[k][1], kDepth));
      if (kind == 0) seen.quad = in_.quad(kWidth, kHeight);
      if (kind == 1) std::swap(seen.quad.corner[1], seen.quad.corner[2]);
      if (kind == 2 && !found.empty()) seen = found.back();
      if (kind == 3) seen.quad.corner[2] = seen.quad.corner[0];
      seen.word = kind == 4 ? std::string(static_cast<std::size_t>(in_.integer(0, 300)), '\xFF')
                            : std::string(1, static_cast<char>(in_.byte()));
      seen.score = in_.number(0, 1);
      found.push_back(seen);
    }
    return found;
  }
  std::vector<tp::TextPoint> points(const tp::SE3d& T_c_w) {
    std::vector<tp::TextPoint> all;
    for (int i = in_.integer(0, 63) * (in_.flag() ? 1 : 0); i > 0; --i) {
      const tp::Vector3<double> p_w = on_wall(), p = T_c_w * p_w;
      tp::TextPoint point = tp::TextPoint::at(camera_.project(p), p_w, i % 40);
      const int kind = in_.byte();
      if (kind < 40) point = tp::TextPoint::track(point.px, i % 40);
      if (kind >= 40 && kind < 80) point = tp::TextPoint::with_depth(point.px, p.z(), kind % 2 ? -1 : i);
      if (kind == 250) point.p_w[kind % 3] = in_.number(-1, 1);
      if (kind == 251) point.px[kind % 2] = in_.number(-1, 90);
      if (kind == 252) point.sigma = in_.number(-1, 9);
      if (kind == 253) point.depth = in_.number(-1, 9);
      if (kind == 254) point.id = any_id();
      if (kind == 255 && !all.empty()) point = all.back();
      all.push_back(point);
    }
    return all;
  }
  tp::TextImage with_camera(const tp::PyramidView& pyramid) {
    tp::TextImage image;
    image.pyramid = pyramid;
    image.camera = in_.integer(0, 7) == 0 ? in_.camera(kWidth, kHeight) : camera_;
    image.noise = in_.number(0, 10);
    image.smoothing = in_.number(0, 2);
    return image;
  }

  void track() {
    const tp::SE3d truth = pose(), T = in_.flag() ? truth : tp::se3_exp<double>(small()) * truth;
    const tp::Pyramid frame = image(truth);
    const auto seen = points(truth);
    const tp::TextFit fit = in_.flag() ? map_.track(frame, T, seen) : map_.track(with_camera(frame), T, seen);
    if (!fit.refined) {
      TEXTPLANE_FUZZ_REQUIRE(same_bits(fit.T_c_w, T) && !tp::is_ok(fit.status) == (fit.status != tp::Status::ok));
      return;
    }
    TEXTPLANE_FUZZ_REQUIRE(tp::is_ok(fit.status) && tp::all_finite(fit.T_c_w) && fit.texts > 0);
    TEXTPLANE_FUZZ_REQUIRE(is_covariance<6>(fit.information) && !std::isnan(fit.gain));
  }
  tp::Vector6<double> small() {
    tp::Vector6<double> xi;
    for (int i = 0; i < 6; ++i) xi[i] = in_.tame(-0.01, 0.01);
    return xi;
  }

  void add(int form) {
    const int id = in_.integer(0, 3) == 0 ? any_id() : next_++;
    const tp::SE3d truth = pose(), T = in_.integer(0, 7) == 0 ? tp::se3_exp<double>(small()) * truth : truth;
    const bool was_there = map_.keyframes().has(id);
    auto own = std::make_unique<tp::Pyramid>(image(truth));
    const auto seen = quads(truth);
    const auto known = points(truth);
    const bool usable = own->levels() > 0 && tp::all_finite(T) && !was_there;
    tp::Status status = tp::Status::ok;
    if (form < 4) {
      status = map_.add_keyframe(id, std::move(*own), T, seen, known);
      own = nullptr;
    } else if (form < 7) {
      status = map_.add_keyframe(id, *own, T, seen, known);
    } else {
      status = map_.add_keyframe(id, with_camera(*own), T, seen, known);
    }
    TEXTPLANE_FUZZ_REQUIRE(!tp::is_ok(status) || usable);
    if (tp::is_ok(status)) images_[id] = std::move(own);
  }
  void remove(int id) {
    map_.remove_keyframe(id);
    images_.erase(id);  // so that a later look at its pixels is seen
    TEXTPLANE_FUZZ_REQUIRE(!map_.keyframes().has(id));
    for (const tp::TextObject& text : map_.objects()) {
      TEXTPLANE_FUZZ_REQUIRE(text.host != id);
      for (const int view : text.views) TEXTPLANE_FUZZ_REQUIRE(view != id);
    }
  }
  void move() {
    const bool together = in_.flag();
    const tp::SE3d by = tp::se3_exp<double>(small());
    const tp::KeyframeStore& store = map_.keyframes();
    map_.move([&](int id) { return together ? store.text_keyframe(id).T_c_w() * by : pose(); });
  }

  void check() {
    std::set<int> here;
    int last = -1;
    for (const tp::TextObject& text : map_.objects()) {
      TEXTPLANE_FUZZ_REQUIRE(text.id > last && gone_.count(text.id) == 0 && text.state != tp::TextState::dropped);
      last = text.id;
      here.insert(text.id);
      const auto known = states_.find(text.id);
      TEXTPLANE_FUZZ_REQUIRE(known == states_.end() || text.state >= known->second);
      states_[text.id] = text.state;
      check(text);
    }
    for (const auto& [id, state] : states_)
      if (here.count(id) == 0) gone_.insert(id);
    std::size_t images = 0;
    map_.keyframes().for_each([&](int, const tp::TextKeyframe& keyframe) {
      TEXTPLANE_FUZZ_REQUIRE(tp::all_finite(keyframe.T_w_c));
      images += keyframe.pyramid.levels > 0 ? 1 : 0;
    });
    const auto most = static_cast<std::size_t>(options_.max_images > 0 ? options_.max_images : 0);
    TEXTPLANE_FUZZ_REQUIRE(images <= most && map_.keyframes().size() <= images + map_.objects().size());
    TEXTPLANE_FUZZ_REQUIRE(map_.keyframes().bytes() <= most * (kWidth * kHeight * 3 / 2));
  }
  void check(const tp::TextObject& text) {
    for (std::size_t i = 0; i < text.views.size(); ++i)
      TEXTPLANE_FUZZ_REQUIRE(text.views[i] != text.host && (i == 0 || text.views[i - 1] < text.views[i]));
    std::array<tp::Vector3<double>, 4> corners;
    const bool has_corners = map_.corners(text, &corners);
    TEXTPLANE_FUZZ_REQUIRE(!has_corners || text.has_plane());
    TEXTPLANE_FUZZ_REQUIRE(map_.keyframes().has(text.host));
    if (!text.has_plane()) return;
    TEXTPLANE_FUZZ_REQUIRE(tp::all_finite(text.theta) && is_covariance<3>(text.covariance));
    TEXTPLANE_FUZZ_REQUIRE(tp::is_finite(text.zncc) && text.variance_factor > 0 && tp::is_finite(text.variance_factor));
  }

  Input& in_;
  const tp::TextMapOptions options_;
  const tp::Pinhole<double> camera_{80, 80, 39.5, 29.5};
  std::map<int, std::unique_ptr<tp::Pyramid>> images_;  // the host's own, until it removes the key frame
  tp::TextMap map_;
  std::map<int, tp::TextState> states_;
  std::set<int> gone_;
  int next_ = 0;
};

}  // namespace
}  // namespace textplane_fuzz

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace textplane_fuzz;
  Input in(data, size);
  Host(in).run();
  return 0;
}
