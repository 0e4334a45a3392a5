"""05: follows a planar object through a video from its corners in the first frame."""
import numpy as np
from common import corner_error

import textplane as tp
from textplane.stage import PlaneTracker, Stage, camera_at

stage = Stage("EXIT 24", (0.1, -0.2, 0.0))


def camera(s: float) -> tp.SE3:
    return camera_at((0.4 * s, -0.2 * s * s, 0.4 * s), (0.1 * s, -0.25 * s, 0.4 * s))


tracker = PlaneTracker(stage.view(camera(0)), stage.quad(camera(0)))
worst = 0.0
for T_w_c in map(camera, np.arange(1, 31) / 30):
    status = tracker.track(stage.view(T_w_c))
    assert tp.is_ok(status), status
    worst = max(worst, corner_error(tracker.quad, stage.quad(T_w_c)))
print(f"worst of 30 frames: corners off by {worst:.3f} px")
