"""04: the plane of a sign from many views of known pose, from the sign's pixels. The start is a plane that faces the
camera, 40 degrees off."""
import numpy as np
from common import degrees_between

import textplane as tp
from textplane.stage import Stage, camera_at

stage = Stage("BAGGAGE", (0.3, 0.65, 0.0))
T_w_h = camera_at((0, 0, 0))
truth = stage.theta(T_w_h)
patch = tp.make_patch(stage.view(T_w_h), stage.camera, stage.quad(T_w_h))

# A camera that passes by: near views first, in which a wrong plane still fits.
targets = []
for i in range(1, 7):
    T_w_t = camera_at((0.08 * i, -0.03 * i, 0.02 * i), (0.0, -0.03 * i, 0.0))
    targets.append((tp.Pyramid(stage.view(T_w_t)), T_w_t.inverse() @ T_w_h))

start = np.array([0, 0, truth[2]])
theta = start
for n in 2, 4, 6:  # as views come in
    fit = tp.refine_plane(patch, theta, targets[:n], stage.camera, raise_on_failure=True)
    theta = fit.theta
    print(f"{n} views: {fit.status.name}, normal off by {degrees_between(theta, truth):.3f} deg, zncc {fit.zncc:.4f}")
print(f"start: normal off by {degrees_between(start, truth):.1f} deg")
print(f"refined: normal off by {degrees_between(theta, truth):.3f} deg")
