"""What the numbered examples share: how far corners are off."""
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

import textplane as tp

if TYPE_CHECKING:
    from textplane.typing import Array


def corner_error(a: Array, b: Array) -> float:
    """Mean distance of the corners (4, 2), px."""
    return float(np.linalg.norm(a - b, axis=1).mean())


def warped(quad: Array, theta: Array, T_t_h: tp.SE3, camera: tp.Camera) -> Array:
    """The quad through the plane; NaN where it is behind the camera."""
    out = tp.project_quad(quad, camera, theta, T_t_h, camera)
    return np.full((4, 2), np.nan) if out is None else out


def degrees_between(a: Array, b: Array) -> float:
    """Between the normals of two planes theta."""
    return float(np.degrees(np.arccos(min(float(tp.plane_normal(a) @ tp.plane_normal(b)), 1.0))))
