"""Rendered input with exact truth, and the tracker of planes: what the numbered examples run on."""
from ._slam import PlaneTracker, Stage, camera_at, render

__all__ = ["PlaneTracker", "Stage", "camera_at", "render"]
