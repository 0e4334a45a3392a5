#include "slam/results.hpp"

#include <utility>

#include "textplane/landmarks/text_view.hpp"
#include "textslam/report/localisation.hpp"

namespace binding {

using textslam::FrameState;

FrameResult result_of(const textslam::FrameRecord& r, int index) {
  FrameResult out;
  out.index = index;
  out.timestamp = r.timestamp;
  out.state = r.state;
  out.by = r.by;
  if (r.state == FrameState::tracked) {
    out.T_w_c = r.T_w_c_live;
    out.position_sigma = r.position_sigma;
  }
  out.map = r.map;
  out.keyframe = r.keyframe;
  out.points = r.points;
  out.texts = r.texts;
  return out;
}

std::vector<MappedText> texts_of(const textslam::Map& map) {
  std::vector<MappedText> out;
  for (const tp::TextObject& text : map.texts) {
    MappedText one;
    if (text.state != tp::TextState::mapped || !tp::is_ok(tp::text_corners(text, &one.corners))) continue;
    const tp::SE3d& T_w_h = map.keyframe(text.host).T_w_c;
    for (Vec3& corner : one.corners) corner = T_w_h * corner;
    one.id = text.id;
    one.observations = static_cast<int>(text.views.size()) + 1;
    one.host = map.keyframe(text.host).frame.index;
    one.word = text.votes.empty() ? std::string() : tp::consensus(text.votes);
    one.theta = text.theta;
    one.normal = tp::product(T_w_h.R, tp::plane_normal(text.theta));
    one.zncc = text.zncc;
    out.push_back(std::move(one));
  }
  return out;
}

void bind_results(py::module_& m) {
  py::enum_<FrameState>(m, "FrameState", "What became of a frame.")
      .value("waiting", FrameState::waiting)
      .value("tracked", FrameState::tracked)
      .value("lost", FrameState::lost);
  py::class_<FrameResult> c(m, "FrameResult", "What System.process() found.");
  field(c, "index", &FrameResult::index, "int: Of the frame, from 0.");
  field(c, "timestamp", &FrameResult::timestamp, "float: Of the frame, s.");
  field(c, "state", &FrameResult::state, "FrameState: Whether it has a pose.");
  c.def_property_readonly(
      "T_w_c",
      [](const FrameResult& self) {
        return self.state == FrameState::tracked ? py::cast(self.T_w_c) : py::object(py::none());
      },
      "SE3 | None: Camera to the live world; None unless it is tracked.");
  c.def_property_readonly(
      "found_by", [](const FrameResult& self) { return textslam::to_string(self.by); },
      "str: What gave the pose: tracking, or texts, images or points of the map; nothing.");
  field(c, "position_sigma", &FrameResult::position_sigma,
        "float: Of the camera, as a share of the scene's depth, where it is tracked.");
  field(c, "map", &FrameResult::map, "int: Number of its map; -1: none.");
  field(c, "keyframe", &FrameResult::keyframe, "int: Key frame that its pose is relative to; -1: none.");
  field(c, "points", &FrameResult::points, "int: Points that its pose rests on.");
  field(c, "texts", &FrameResult::texts, "int: Texts that its pose rests on.");
  c.def(
      "__repr__", [](Handle self) { return describe(self); }, "__repr__() -> str\n\nIts numbers.");

  py::class_<MappedText> text(m, "MappedText", "A text of the map, in its world.");
  field(text, "id", &MappedText::id, "int: Never used twice.");
  field(text, "observations", &MappedText::observations, "int: Key frames that show it.");
  field(text, "host", &MappedText::host, "int: Index of its host frame.");
  text.def_property_readonly(
      "word", [](const MappedText& self) { return py::bytes(self.word).attr("decode")("utf-8", "replace"); },
      "str: What most readings agree on; empty or ### where it is not read.");
  text.def_property_readonly(
      "corners",
      [](const MappedText& self) {
        py::array_t<double> out({4, 3});
        double* p = out.mutable_data();
        for (const Vec3& corner : self.corners)
          for (const int k : {0, 1, 2}) *p++ = corner[k];
        return out;
      },
      "Array: Clockwise from the text's top left, (4, 3).");
  field(text, "normal", &MappedText::normal, "Array: Unit normal towards the host camera, (3,).");
  field(text, "theta", &MappedText::theta, "Array: The plane in the host's frame, (3,).");
  field(text, "zncc", &MappedText::zncc, "float: Mean over its last refinement.");
  text.def(
      "__repr__", [](Handle self) { return describe(self); }, "__repr__() -> str\n\nIts numbers.");
}

}  // namespace binding
