// What the files of textplane._slam share: detections from Python, settings, and failures.
#ifndef TEXTPLANE_PYTHON_SLAM_HPP
#define TEXTPLANE_PYTHON_SLAM_HPP

#include <string>
#include <vector>

#include "arguments.hpp"
#include "binding.hpp"
#include "io/detections.hpp"
#include "textslam/common/parameters.hpp"

namespace binding {

void bind_system(py::module_& m);
void bind_run(py::module_& m);
void bind_stage(py::module_& m);

/// What a detector gives: corners (4, 2) each, or a tuple (quads, scores, words); scores and words may be None.
std::vector<textslam::Detection> detections_of(Handle from);
/// The system's parameters, by the names of parameters.inc.
textslam::Parameters parameters_of(const std::string& mode, const py::dict& settings);

}  // namespace binding

#endif  // TEXTPLANE_PYTHON_SLAM_HPP
