// The rooms of textplane._core: a file each, so that they compile side by side.
#ifndef TEXTPLANE_PYTHON_CORE_HPP
#define TEXTPLANE_PYTHON_CORE_HPP

#include "arguments.hpp"
#include "binding.hpp"

namespace binding {

void bind_types(py::module_& m);    // Status, Failure, SE3
void bind_cameras(py::module_& m);  // Camera
void bind_planes(py::module_& m);   // theta and its fits
void bind_homographies(py::module_& m);
void bind_quads(py::module_& m);
void bind_images(py::module_& m);   // Pyramid, warps, ZNCC, noise
void bind_patches(py::module_& m);  // TextPatch
void bind_options(py::module_& m);  // of residuals and solvers
void bind_pose(py::module_& m);     // align_pose, refine_pose, search_pose
void bind_plane_solver(py::module_& m);
void bind_residuals(py::module_& m);  // linearise_*, residuals, evaluate
void bind_features(py::module_& m);   // FAST, KLT
void bind_window(py::module_& m);     // solve_window
void bind_text_map(py::module_& m);   // TextMap

}  // namespace binding

#endif  // TEXTPLANE_PYTHON_CORE_HPP
