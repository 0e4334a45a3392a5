// The rooms of textplane._core: a file and a namespace each, so that they compile side by side, or as one unit.
#ifndef TEXTPLANE_PYTHON_CORE_HPP
#define TEXTPLANE_PYTHON_CORE_HPP

#include "arguments.hpp"
#include "binding.hpp"

namespace binding {

// clang-format off
namespace of_types { void bind(py::module_& m); }    // Status, Failure, SE3
namespace of_cameras { void bind(py::module_& m); }  // Camera
namespace of_planes { void bind(py::module_& m); }   // theta and its fits
namespace of_homographies { void bind(py::module_& m); }
namespace of_quads { void bind(py::module_& m); }
namespace of_images { void bind(py::module_& m); }   // Pyramid, warps, ZNCC, noise
namespace of_patches { void bind(py::module_& m); }  // TextPatch
namespace of_options { void bind(py::module_& m); }  // of residuals and solvers
namespace of_pose { void bind(py::module_& m); }     // align_pose, refine_pose, search_pose
namespace of_plane_solver { void bind(py::module_& m); }
namespace of_residuals { void bind(py::module_& m); }  // linearise_*, residuals, evaluate
namespace of_features { void bind(py::module_& m); }   // FAST, KLT
namespace of_window { void bind(py::module_& m); }     // solve_window
namespace of_text_map { void bind(py::module_& m); }   // TextMap
// clang-format on

}  // namespace binding

#endif  // TEXTPLANE_PYTHON_CORE_HPP
