"""08: a lost camera: of a thousand poses the one with the best ZNCC, then its refinement."""
import numpy as np
from common import corner_error, warped

import textplane as tp
from textplane.stage import Stage, camera_at

stage = Stage("LIBRARY", (0.1, 0.3, 0.0))
T_w_h, T_w_t = camera_at((0, 0, 0)), camera_at((0.3, 0.15, 0.2), (-0.05, -0.1, 0.05))
theta, there = stage.theta(T_w_h), stage.quad(T_w_t)
patch = tp.make_patch(stage.view(T_w_h), stage.camera, stage.quad(T_w_h))
pyramid = tp.Pyramid(stage.view(T_w_t))

# Poses within about 40 cm and 8 degrees of the host's own, on level 2, where near poses already correlate.
random = np.random.default_rng(8)
twists = random.uniform(-1, 1, (1000, 6)) * (0.4, 0.4, 0.4, 0.15, 0.15, 0.15)
poses = [tp.SE3.exp(xi) for xi in twists]
zncc, _ = tp.zncc_candidates(patch, theta, poses, pyramid, stage.camera, level=2)
best = int(zncc.argmax())
fit = tp.align_pose(patch, theta, poses[best], pyramid, stage.camera)


def off(T: tp.SE3) -> float:
    return corner_error(warped(patch.quad, theta, T, stage.camera), there)


print(f"best of {len(poses)}: zncc {zncc[best]:.3f}, corners off by {off(poses[best]):.2f} px; not moved at all "
      f"{corner_error(patch.quad, there):.2f} px")
print(f"refined: corners off by {off(fit.T_t_h):.3f} px")
