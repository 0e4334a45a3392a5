// TextMap::track(): a frame with at most twenty signs in view, against the number of mapped texts, with two hundred
// points and with none. And what the batch kernel would take for its parts: twenty texts of n pixels each, by batch and
// one by one; and refine_pose() on them, which takes them together where they are small.
#include "registry.hpp"
#include "support/text_wall.hpp"
#include "textplane/photometry/text_batch.hpp"
#include "textplane/solver/pose.hpp"

namespace textplane_bench {

namespace tp = textplane;

namespace {

const textplane_test::TextWall& the_wall() {
  static const textplane_test::TextWall wall;
  return wall;
}

Work track(int texts, bool with_points) {
  const textplane_test::TextWall& wall = the_wall();
  const auto map = std::make_shared<tp::TextMap>(wall.camera);
  wall.fill(*map, texts);
  const auto points = with_points ? wall.points : std::vector<tp::TextPoint>();
  Work work;
  const tp::TextFit& fit = map->track(wall.frame, wall.start, points);
  work.errors["error"] = 1000 * (fit.T_c_w.inverse().t - wall.T_c_w.inverse().t).norm();  // mm
  work.call = [&wall, map, points](std::size_t) { keep(map->track(wall.frame, wall.start, points).texts); };
  return work;
}

// The signs in view on level 0, cut to n pixels each.
struct Texts {
  explicit Texts(int n) : map(the_wall().camera), workspace(n) {
    const textplane_test::TextWall& wall = the_wall();
    wall.fill(map, textplane_test::TextWall::kInView);
    for (const tp::TextObject& text : map.objects()) {
      tp::PhotometricInput input = tp::photometric_input(text.patch, 0, wall.frame.view(), wall.camera);
      input.patch.n = std::min(n, input.patch.n);
      input.patch.bounds = tp::simd::point_bounds(input.patch.x, input.patch.y, input.patch.n);
      requests.push_back({input, text.theta, wall.T_c_w});
      items.push_back({input.patch, input.host_camera, text.theta});
    }
    poses.assign(items.size(), wall.T_c_w);
    batch.build(items.data(), static_cast<int>(items.size()));
    result.reserve(batch);
  }
  tp::ImageView8 image() const { return the_wall().frame.view().level[0]; }

  tp::TextMap map;
  tp::PhotometricWorkspace workspace;
  std::vector<tp::ResidualRequest<std::uint8_t>> requests;
  std::vector<tp::TextBatchItem> items;
  std::vector<tp::SE3d> poses;
  tp::TextBatch batch;
  tp::TextBatchResult result;
};

// refine_pose() on the finest level, from the wall's start; nanoseconds are of one text and iteration. A rig of one
// camera takes the texts one by one.
struct SmallTexts : Texts {
  explicit SmallTexts(int n) : Texts(n) {
    const textplane_test::TextWall& wall = the_wall();
    for (const tp::TextObject& text : map.objects()) patches.push_back(text.patch);
    for (std::size_t i = 0; i < patches.size(); ++i) {
      textplane_test::keep_pixels(patches[i], n);
      terms.push_back({&patches[i], map.objects()[i].theta, tp::SE3d()});
    }
    options.coarsest_level = 0;
    memory.reserve(terms.data(), static_cast<int>(terms.size()), 0);
    rig = {wall.camera, tp::SE3d(), wall.frame.view()};
  }
  tp::PoseFit together() {
    return tp::refine_pose(terms.data(), static_cast<int>(terms.size()), nullptr, 0, rig.target, rig.camera,
                           the_wall().start, options, memory);
  }
  tp::PoseFit one_by_one() {
    return tp::refine_pose(terms.data(), static_cast<int>(terms.size()), nullptr, 0, &rig, 1, the_wall().start, options,
                           memory);
  }

  std::vector<tp::TextPatch> patches;
  std::vector<tp::PoseTextTerm> terms;
  tp::PoseCamera rig;
  tp::PoseOptions options;
  tp::PoseWorkspace memory;
};

template <class Solve>
void add_poses(const std::string& name, const Solve& solve) {
  for (const int n : {15, 30})
    add_targets("text_map_" + name, std::to_string(n), [n, solve] {
      const auto texts = std::make_shared<SmallTexts>(n);
      Work work;
      work.items = static_cast<double>(texts->terms.size()) * solve(*texts).iterations;
      work.call = [texts, solve](std::size_t) { keep(solve(*texts).iterations); };
      return work;
    });
}

template <class Call>
void add_parts(const std::string& name, const Call& call) {
  for (const int n : {15, 30, 60, 120, 250})
    add_targets("text_map_" + name, std::to_string(n), [n, call] {
      const auto texts = std::make_shared<Texts>(n);
      Work work;
      work.call = [texts, call](std::size_t) { call(*texts); };
      return work;
    });
}

void add_all_parts() {
  const tp::Pinhole<double>& camera = the_wall().camera;
  add_parts("pack", [](Texts& t) { keep(t.batch.build(t.items.data(), static_cast<int>(t.items.size()))); });
  add_parts("cost_batch", [&camera](Texts& t) {
    keep(tp::evaluate_batch(t.batch, t.image(), camera, t.poses.data(), {}, t.result));
  });
  add_parts("cost_single", [](Texts& t) {
    for (const auto& request : t.requests) keep(tp::evaluate(request, t.workspace));
  });
  add_parts("equations_batch", [&camera](Texts& t) {
    keep(tp::linearise_batch<tp::Parameters::pose_plane>(t.batch, t.image(), camera, t.poses.data(), {}, t.result));
  });
  add_parts("equations_single", [](Texts& t) {
    for (const auto& request : t.requests) keep(tp::linearise<tp::Parameters::pose_plane>(request, t.workspace));
  });
}

}  // namespace

void add_text_map() {
  add_all_parts();
  add_poses("pose_batch", [](SmallTexts& t) { return t.together(); });
  add_poses("pose_single", [](SmallTexts& t) { return t.one_by_one(); });
  for (const int texts : {1, 10, 100, 1000, 10000}) {
    add_targets("text_map", std::to_string(texts), [texts] { return track(texts, true); });
    add_targets("text_map_without_points", std::to_string(texts), [texts] { return track(texts, false); });
  }
}

}  // namespace textplane_bench
