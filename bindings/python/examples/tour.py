# %% [markdown]
# A tour of textplane: one sign, its plane, its pose in other light, how far a guess may be off, and a map of many.
# An editor that knows `# %%` cells, or `jupytext`, opens it as a notebook. `MPLBACKEND=agg python3 tour.py [FOLDER]`
# writes its pictures as PNG, by matplotlib.

# %%
from __future__ import annotations

import json
import pathlib
import sys
from typing import TYPE_CHECKING

import matplotlib.pyplot as plt
import numpy as np
from common import corner_error, warped

import textplane as tp
from textplane import slam
from textplane.stage import Stage, camera_at, render

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from textplane.typing import Array

FOLDER = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else "tour")
FOLDER.mkdir(parents=True, exist_ok=True)


def show(axes: Axes, image: Array, title: str, quad: Array | None = None) -> None:
    axes.imshow(image, cmap="gray", vmin=0, vmax=255)
    if quad is not None:
        axes.plot(*np.vstack([quad, quad[:1]]).T, color="tab:orange")
    axes.set_title(title)
    axes.axis("off")


# %% [markdown]
# **One sign in two views.** The stage renders a sign whose plane is known exactly.

# %%
stage = Stage("MUSEUM", (0.1, -0.3, 0.0))
T_w_h, T_w_t = camera_at((0, 0, 0)), camera_at((0.5, 0.1, 0.2), (0.0, -0.2, 0.05))
T_t_h = T_w_t.inverse() @ T_w_h
host, target = stage.view(T_w_h), stage.view(T_w_t, gain=0.6, bias=40)
figure, axes = plt.subplots(1, 2, figsize=(9, 3.6))
show(axes[0], host, "host", stage.quad(T_w_h))
show(axes[1], target, "target, in other light", stage.quad(T_w_t))
figure.savefig(FOLDER / "1_views.png")

# %% [markdown]
# **Its plane** from corners seen in both, `theta = -n / d`, and the plane's homography: the host's pixels as the target
# should see them.

# %%
corners = [stage.camera.unproject(np.round(4 * stage.quad(T)) / 4) for T in (T_w_h, T_w_t)]
plane = tp.plane_from_matches(corners[0], corners[1], T_t_h, raise_on_failure=True)
print(f"theta {plane.value.round(4)}, true {stage.theta(T_w_h).round(4)}")
H_h_t = tp.plane_homography_inverse(plane.value, T_t_h)
assert H_h_t is not None
pixel_H = tp.pixel_homography(H_h_t, stage.camera, stage.camera)
predicted, _pixels, _status = tp.warp_patch(host, pixel_H, np.empty_like(target))
figure, axes = plt.subplots(1, 2, figsize=(9, 3.6))
show(axes[0], predicted, "predicted from the host", stage.quad(T_w_t))
show(axes[1], target, "target")
figure.savefig(FOLDER / "2_plane.png")

# %% [markdown]
# **Its pose, whatever the light.** Mean and contrast are taken out of each patch, so gain and bias cancel.

# %%
patch = tp.make_patch(host, stage.camera, stage.quad(T_w_h))
guess = tp.SE3.exp((0.02, -0.01, 0.03, 0.005, -0.005, 0.02)) @ T_t_h
gains = np.linspace(0.2, 1.0, 9)
errors, correlations = [], []
for gain in gains:
    dim = tp.Pyramid(stage.view(T_w_t, gain=float(gain), bias=30))
    fit = tp.align_pose(patch, stage.theta(T_w_h), guess, dim, stage.camera, raise_on_failure=True)
    errors.append(corner_error(warped(patch.quad, stage.theta(T_w_h), fit.T_t_h, stage.camera), stage.quad(T_w_t)))
    correlations.append(fit.zncc)
figure, axes = plt.subplots(figsize=(5, 3.6))
axes.plot(gains, errors, "o-")
axes.set(xlabel="gain", ylabel="corners off by, px", title=f"ZNCC {min(correlations):.4f} or more")
figure.tight_layout()
figure.savefig(FOLDER / "3_light.png")
print(f"corners off by at most {max(errors):.3f} px")

# %% [markdown]
# **How far a guess may be off.** Shifts of the camera sideways and upwards, from which the alignment comes back.

# %%
shifts = np.linspace(-0.1, 0.1, 21)
pyramid = tp.Pyramid(target)
found = np.zeros((len(shifts), len(shifts)))
for i, y in enumerate(shifts):
    for j, x in enumerate(shifts):
        fit = tp.align_pose(patch, stage.theta(T_w_h), tp.SE3.exp((x, y, 0, 0, 0, 0)) @ T_t_h, pyramid, stage.camera)
        seen = warped(patch.quad, stage.theta(T_w_h), fit.T_t_h, stage.camera)
        found[i, j] = fit.ok and corner_error(seen, stage.quad(T_w_t)) < 0.5
figure, axes = plt.subplots(figsize=(4.4, 4))
axes.imshow(found, extent=(-10, 10, -10, 10), origin="lower", cmap="Greens", vmin=0, vmax=1.3)
axes.set(xlabel="guess to the side, cm", ylabel="guess upwards, cm", title=f"{100 * found.mean():.0f} % come back")
figure.tight_layout()
figure.savefig(FOLDER / "4_basin.png")
print(f"share of guesses that come back {found.mean():.2f}")

# %% [markdown]
# **A map of many.** A rendered room, and what the example system makes of it: the camera's path, and the signs from
# above, with the words that it read.

# %%
render(str(FOLDER / "room"), frames=90, width=320, height=240)
done = slam.run(str(FOLDER / "room"), str(FOLDER / "out"))
path = np.loadtxt(FOLDER / "out/trajectory.txt")
texts = json.loads((FOLDER / "out/text_map.json").read_text(encoding="utf-8"))["texts"]
figure, axes = plt.subplots(figsize=(5, 4))
axes.plot(path[:, 1], path[:, 3])
for text in texts:
    ends = np.array(text["corners"])[:2]
    axes.plot(ends[:, 0], ends[:, 2], linewidth=3)
    axes.annotate(text["text"], ends[0, [0, 2]])
axes.set(xlabel="x", ylabel="z", aspect="equal", title=f"{done.texts} texts, {done.tracked} of {done.frames} frames")
figure.tight_layout()
figure.savefig(FOLDER / "5_map.png")
print(f"texts mapped {done.texts}")
