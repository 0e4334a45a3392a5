"""The example system textslam: monocular SLAM with points and planar text. docs/python.md has an example of each."""
from __future__ import annotations

import html
import pathlib

from ._slam import FrameResult, FrameState, MappedText, Run, System, load_image, run

__all__ = ["FrameResult", "FrameState", "MappedText", "Run", "System", "load_image", "run"]


def _framed(page: str) -> str:
    """A page of HTML inside another."""
    return f'<iframe srcdoc="{html.escape(page)}" style="width: 100%; height: 600px; border: 0"></iframe>'


def _show(self: System | Run) -> str:
    """The report, for notebooks; what there is to say, where there is none (yet)."""
    page = ""
    if isinstance(self, Run):
        if self.report:
            page = pathlib.Path(self.report).read_text(encoding="utf-8")
    elif self.finished:
        page = self.report()
    return _framed(page) if page else f"<pre>{html.escape(repr(self))}</pre>"


for _class in System, Run:
    setattr(_class, "_repr_html_", _show)
