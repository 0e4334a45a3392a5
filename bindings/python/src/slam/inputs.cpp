// What Python gives to the system.
#include <type_traits>

#include "slam/slam.hpp"

namespace binding {

namespace {

using textslam::Mode;  // as parameters.inc says it

template <class T>
void set_parameter(T* to, const std::string& name, Handle value) {
  try {
    if constexpr (!std::is_same<T, textslam::Mode>::value) *to = value.cast<T>();
  } catch (const py::cast_error&) {
    throw py::type_error("parameters: \"" + name + "\" is " + std::string(py::str(py::type::handle_of(value))) +
                         ", which is no number for it");
  }
}

bool set_by_name(textslam::Parameters* p, const std::string& wanted, Handle value) {
  bool found = false;
#define SECTION(title)
#define FIELD(type, name, otherwise, meaning)     \
  if (wanted == #name && wanted != "mode") {      \
    set_parameter<type>(&p->name, wanted, value); \
    found = true;                                 \
  }
#define TEXT_FIELD(name, member, meaning)          \
  if (wanted == #name) {                           \
    set_parameter(&p->text.member, wanted, value); \
    found = true;                                  \
  }
#include "textslam/common/parameters.inc"
#undef TEXT_FIELD
#undef FIELD
#undef SECTION
  return found;
}

}  // namespace

std::vector<textslam::Detection> detections_of(Handle from) {
  std::vector<textslam::Detection> out;
  if (from.is_none()) return out;
  const char* what = "corners (4, 2) of each text, or a tuple (quads, scores, words)";
  Handle quads = from, scores = py::none(), words = py::none();
  if (py::isinstance<py::tuple>(from) && py::len(from) == 3) {
    const auto all = py::reinterpret_borrow<py::tuple>(from);
    quads = PyTuple_GET_ITEM(all.ptr(), 0);
    scores = PyTuple_GET_ITEM(all.ptr(), 1);
    words = PyTuple_GET_ITEM(all.ptr(), 2);
  }
  if (!PySequence_Check(quads.ptr()) || PyUnicode_Check(quads.ptr())) expected("detections", what, quads);
  for (const py::object corners : py::reinterpret_borrow<py::sequence>(quads)) {
    textslam::Detection detection;
    detection.quad = quad(corners, "detections: quads");
    out.push_back(detection);
  }
  const int n = static_cast<int>(out.size());
  if (!scores.is_none()) {
    const auto numbers = py::array_t<double>::ensure(scores);
    if (!numbers || numbers.ndim() != 1) expected("detections: scores", "numbers (n,)", scores);
    same_length(n, "quads", static_cast<int>(numbers.size()), "scores");
    for (int i = 0; i < n; ++i) out[static_cast<std::size_t>(i)].score = numbers.at(i);
  }
  if (!words.is_none()) {
    if (!PySequence_Check(words.ptr())) expected("detections: words", "strings", words);
    const auto all = py::reinterpret_borrow<py::sequence>(words);
    same_length(n, "quads", static_cast<int>(py::len(all)), "words");
    for (int i = 0; i < n; ++i) {
      const py::object word = all[static_cast<std::size_t>(i)];
      if (word.is_none()) continue;
      if (!PyUnicode_Check(word.ptr())) expected("detections: words", "strings", word);
      const auto text = word.cast<std::string>();
      if (!text.empty()) out[static_cast<std::size_t>(i)].text = text;
    }
  }
  return out;
}

textslam::Parameters parameters_of(const std::string& mode, const py::dict& settings) {
  textslam::Parameters p;
  if (mode != "text" && mode != "points" && mode != "loose")
    throw py::value_error("mode: expected \"text\", \"points\" or \"loose\", got \"" + mode + "\"");
  p.mode = mode == "text" ? textslam::Mode::text : mode == "points" ? textslam::Mode::points : textslam::Mode::loose;
  for (const auto& [key, value] : settings) {
    const std::string name = py::str(key);
    if (!set_by_name(&p, name, value)) throw py::value_error("parameters: there is no \"" + name + "\"");
  }
  return p;
}

}  // namespace binding
