"""01: predicts how another view will see a sign of one view. It needs plane and pose, which give a homography."""
import numpy as np

import textplane as tp
from textplane.stage import Stage, camera_at

stage = Stage("WELCOME", (0.1, 0.4, 0.0))
T_w_h = camera_at((0, 0, 0))  # host: the view that is known
T_w_t = camera_at((0.7, -0.2, 0.2), (0.1, -0.35, 0.1))  # target: the view to come
host, target = stage.view(T_w_h), stage.view(T_w_t)

# warp_patch() maps each pixel of the output to its source: target to host.
H_h_t = tp.plane_homography_inverse(stage.theta(T_w_h), T_w_t.inverse() @ T_w_h)
assert H_h_t is not None
pixel_H = tp.pixel_homography(H_h_t, stage.camera, stage.camera)
predicted, _pixels, _status = tp.warp_patch(host, pixel_H, np.empty_like(target))

# How well the prediction fits: ZNCC (1 is perfect) inside the text's quad.
quad = stage.quad(T_w_t)
inside = np.array([[tp.quad_contains(quad, (x, y)) for x in range(480)] for y in range(360)])
print(f"zncc {tp.zncc(predicted[inside], target[inside]):.4f}")
