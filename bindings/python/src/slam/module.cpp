// textplane._slam: the example system, and the stage of the examples. textplane._core has the types of arguments.
#include "slam/slam.hpp"

PYBIND11_MODULE(_slam, m) {
  namespace py = pybind11;
  py::module_::import("textplane._core");
  py::options options;
  options.disable_function_signatures();
  options.disable_enum_members_docstring();
  m.doc() = "The example system textslam, and the stage of the examples.";
  binding::bind_system(m);
  binding::bind_run(m);
  binding::bind_stage(m);
}
