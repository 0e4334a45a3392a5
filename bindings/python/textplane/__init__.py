"""Planar text features for visual SLAM: kernels and solvers of the C++ library textplane on NumPy arrays."""
from ._core import *  # noqa: F401,F403
from ._core import __version__  # noqa: F401
