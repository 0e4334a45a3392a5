"""Planar text features for visual SLAM: kernels and solvers of the C++ library textplane on NumPy arrays.

textplane.slam has the example system, where it was built. Images are uint8 (height, width), poses are SE3 or matrices
(4, 4), a plane is theta (3,) of the host's frame: docs/conventions.md and docs/python.md of the repository.
"""
from . import show as _show
from ._core import *  # noqa: F401,F403
from ._core import TextMap, __version__  # noqa: F401

setattr(TextMap, "_repr_html_", _show.text_map_html)
