"""02: the plane of a sign from three of its corners in two views of known pose. More points make it a least-squares
fit."""
import numpy as np
from common import degrees_between

import textplane as tp
from textplane.stage import Stage, camera_at

stage = Stage("PLATFORM", (0.2, -0.5, 0.1))
T_w_h, T_w_t = camera_at((0, 0, 0)), camera_at((0.6, 0.1, 0.1), (0.0, -0.3, 0.0))

# Corners with errors of a quarter of a pixel, as a detector might give them: the source of the result's error.
host, target = (stage.camera.unproject(np.round(4 * stage.quad(T)[:3]) / 4) for T in (T_w_h, T_w_t))
fit = tp.plane_from_matches(host, target, T_w_t.inverse() @ T_w_h, raise_on_failure=True)
truth = stage.theta(T_w_h)
print(f"theta {fit.value.round(4)}, true {truth.round(4)}")
print(f"rank {fit.rank}, condition {fit.condition:.0f}")
print(f"distance {tp.plane_distance(fit.value):.4f} m, true {tp.plane_distance(truth):.4f} m")
print(f"normal off by {degrees_between(fit.value, truth):.3f} deg")
