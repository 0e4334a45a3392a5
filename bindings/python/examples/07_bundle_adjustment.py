"""07: bundle adjustment of five key frames, two of them fixed, and the plane of one sign, from the sign's pixels alone.
The C++ example does it by Ceres, this one by solve_window()."""
import numpy as np

import textplane as tp
from textplane.stage import Stage, camera_at

stage = Stage("GALLERY", (0.2, 0.5, 0.0))
random = np.random.default_rng(7)
truth = [camera_at((0.15 * i, -0.05 * i, 0.05 * i), (0.02 * i, -0.06 * i, 0.03 * i)) for i in range(5)]
window = tp.Window(stage.camera)
views = [stage.view(T) for T in truth]
for i, T_w_c in enumerate(truth):
    fixed = i in (0, 4)  # two fixed poses fix the gauge, scale included
    error = np.zeros(6) if fixed else random.normal(size=6) * (0.006, 0.006, 0.006, 0.003, 0.003, 0.003)
    window.add_frame(tp.SE3.exp(error) @ T_w_c, fixed, tp.Pyramid(views[i]))
patch = tp.make_patch(views[0], stage.camera, stage.quad(truth[0]))
sign = window.add_text(0, patch, stage.theta(truth[0]) + (0.06, -0.04, 0.01))  # ten degrees off
for frame in range(1, 5):
    window.see_text(frame, sign)


def worst_position() -> float:
    return max(1000 * float(np.linalg.norm(window.pose(i).t - T.t)) for i, T in enumerate(truth))


print(f"before: positions off by {worst_position():.1f} mm at worst")
for level in 2, 1, 0:  # coarse to fine
    summary = tp.solve_window(window, tp.WindowOptions(text_level=level, max_iterations=50), raise_on_failure=True)
    print(f"level {level}: {summary.status.name}, cost {summary.initial_cost:.1f} to {summary.final_cost:.1f}")
print(f"after: positions off by {worst_position():.2f} mm at worst")
print(f"theta off by {np.linalg.norm(window.theta(sign) - stage.theta(truth[0])):.5f}")
