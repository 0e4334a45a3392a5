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
  binding::bind_types(m);
  binding::bind_cameras(m);
  binding::bind_planes(m);
  binding::bind_homographies(m);
  binding::bind_quads(m);
  binding::bind_images(m);
  binding::bind_options(m);
  binding::bind_patches(m);
  binding::bind_pose(m);
  binding::bind_plane_solver(m);
  binding::bind_residuals(m);
  binding::bind_features(m);
  binding::bind_window(m);
  binding::bind_text_map(m);
}
