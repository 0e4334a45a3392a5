"""06: aligns one sign in six lights from the same guess. Gain and bias cancel exactly; the robust cost deals with a
vignette and a reflection."""
from common import corner_error, warped

import textplane as tp
from textplane.stage import Stage, camera_at

stage = Stage("MUSEUM", (0.1, -0.3, 0.0))
T_w_h, T_w_t = camera_at((0, 0, 0)), camera_at((-0.3, 0.1, 0.2), (0.0, 0.15, -0.05))
theta = stage.theta(T_w_h)
patch = tp.make_patch(stage.view(T_w_h), stage.camera, stage.quad(T_w_h))
guess = tp.SE3.exp((0.01, -0.005, 0.03, -0.005, 0.005, 0.02)) @ T_w_t.inverse() @ T_w_h
targets = {
    "steady": stage.view(T_w_t),
    "dim": stage.view(T_w_t, gain=0.35),
    "bright": stage.view(T_w_t, gain=1.15),  # some of it is clipped at 255
    "haze": stage.view(T_w_t, gain=0.5, bias=90),
    "vignette": stage.view(T_w_t, vignette=0.7),
    "reflex": stage.view(T_w_t, glare=(210, 170, 30, 120)),
}
worst = 0.0
for name, target in targets.items():
    fit = tp.align_pose(patch, theta, guess, tp.Pyramid(target), stage.camera)
    off = corner_error(warped(patch.quad, theta, fit.T_t_h, stage.camera), stage.quad(T_w_t))
    worst = max(worst, off if fit.ok else 1e3)
    print(f"{name:8} {fit.status.name:9} zncc {fit.zncc:.4f}, corners off by {off:.3f} px")
print(f"worst: corners off by {worst:.3f} px")
