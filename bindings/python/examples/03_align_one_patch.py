"""03: the pose of a camera from one sign whose plane is known. The guess is off by four centimetres and one degree."""
import numpy as np
from common import corner_error, warped

import textplane as tp
from textplane.stage import Stage, camera_at

stage = Stage("TICKETS", (0.1, 0.4, 0.0))
T_w_h, T_w_t = camera_at((0, 0, 0)), camera_at((0.4, -0.1, 0.3), (0.05, -0.2, 0.1))
truth = T_w_t.inverse() @ T_w_h
host, target = stage.view(T_w_h), stage.view(T_w_t)
theta, quad = stage.theta(T_w_h), stage.quad(T_w_h)
guess = tp.SE3.exp((0.02, -0.01, 0.03, 0.005, -0.005, 0.02)) @ truth  # (v, omega): metres, radians

patch = tp.make_patch(host, stage.camera, quad)
fit = tp.align_pose(patch, theta, guess, tp.Pyramid(target), stage.camera, raise_on_failure=True)


def off(T: tp.SE3) -> float:
    return corner_error(warped(quad, theta, T, stage.camera), stage.quad(T_w_t))


print(f"{fit.status.name} after {fit.iterations} iterations, zncc {fit.zncc:.4f}, {fit.visible_pixels} pixels")
print(f"guess: corners off by {off(guess):.2f} px")
print(f"aligned: corners off by {off(fit.T_t_h):.3f} px")
print(f"position off by {1000 * np.linalg.norm(fit.T_t_h.inverse().t - truth.inverse().t):.2f} mm")
