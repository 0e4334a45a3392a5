// textplane._core: kernels and solvers.
#include "core/core.hpp"
#include "textplane/simd/dispatch.hpp"

PYBIND11_MODULE(_core, m) {
  namespace py = pybind11;
  py::options options;
  options.disable_function_signatures();
  options.disable_enum_members_docstring();
  m.doc() = "Kernels and solvers of textplane on NumPy arrays.";
  m.attr("__version__") = TEXTPLANE_VERSION_STRING;
  binding::of_types::bind(m);
  binding::of_cameras::bind(m);
  binding::of_planes::bind(m);
  binding::of_homographies::bind(m);
  binding::of_quads::bind(m);
  binding::of_images::bind(m);
  binding::of_options::bind(m);
  binding::of_patches::bind(m);
  binding::of_pose::bind(m);
  binding::of_plane_solver::bind(m);
  binding::of_residuals::bind(m);
  binding::of_features::bind(m);
  binding::of_window::bind(m);
  binding::of_text_map::bind(m);
}
