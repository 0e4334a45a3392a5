// Parameters: every number that the system works with. parameters.inc lists them; a new one is a line there.
#ifndef TEXTSLAM_COMMON_PARAMETERS_HPP
#define TEXTSLAM_COMMON_PARAMETERS_HPP

namespace textslam {

enum class Mode {
  text,    ///< Points and text planes in one cost.
  points,  ///< Points alone; detections are not used.
  loose,   ///< The paper's comparison: poses and points as in `points`; text planes fitted to the points afterwards.
};

struct Parameters {
#define SECTION(title)
#define FIELD(type, name, value, meaning) type name = value;
#include "textslam/common/parameters.inc"
#undef FIELD
#undef SECTION
};

/// Calls visit(section, name, value, meaning) for each parameter, in the order of the list.
template <class Visit>
void for_each_parameter(const Parameters& parameters, Visit visit) {
  const char* section = "";
#define SECTION(title) section = title;
#define FIELD(type, name, value, meaning) visit(section, #name, parameters.name, meaning);
#include "textslam/common/parameters.inc"
#undef FIELD
#undef SECTION
}

}  // namespace textslam

#endif  // TEXTSLAM_COMMON_PARAMETERS_HPP
