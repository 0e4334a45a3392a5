// Windowed bundle adjustment: Levenberg-Marquardt over key-frame poses, points and text planes with the Schur complement.
// See window_problem.hpp for the data, the cost and the gauge.
#ifndef TEXTPLANE_SOLVER_WINDOW_HPP
#define TEXTPLANE_SOLVER_WINDOW_HPP

#include "textplane/solver/window_problem.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// Memory of solve_window(), to be reused from call to call. Not to be shared by two threads at a time.
class WindowWorkspace {
 public:
  WindowWorkspace() = default;
};

WindowSummary solve_window(Window& window, const WindowOptions& options, WindowWorkspace& workspace);
WindowSummary solve_window(Window& window, const WindowOptions& options = {});

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_SOLVER_WINDOW_HPP
