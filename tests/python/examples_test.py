"""The numbered examples print what those of C++ print, within the bounds of tests/examples.cmake."""
import contextlib
import io
import os
import pathlib
import re
import runpy
import sys

import pytest

pytest.importorskip("textplane._slam")
FOLDER = pathlib.Path(os.environ.get("TEXTPLANE_PYTHON", pathlib.Path(__file__).parents[2] / "bindings/python"))
BOUNDS = re.findall(r'textplane_test_example\((0\d)_\S+ "([^"]+)" (ABOVE|BELOW)=([\d.]+)\)',
                    (pathlib.Path(__file__).parents[1] / "examples.cmake").read_text())


def test_there_are_eight():
    assert [number for number, *_ in BOUNDS] == [f"{i:02}" for i in range(1, 9)]
    assert len(list((FOLDER / "examples").glob("0?_*.py"))) == 8


@pytest.mark.parametrize("number, text, side, bound", BOUNDS)
def test_numbered_example(number, text, side, bound, monkeypatch):
    program = next((FOLDER / "examples").glob(f"{number}_*.py"))
    monkeypatch.setattr(sys, "path", [str(program.parent), *sys.path])
    output = io.StringIO()
    with contextlib.redirect_stdout(output):
        runpy.run_path(str(program))
    match = re.search(re.escape(text) + r" ([\d.]+)", output.getvalue())
    assert match, output.getvalue()
    number = float(match[1])
    assert number > float(bound) if side == "ABOVE" else number < float(bound), output.getvalue()


def test_the_tour(tmp_path, monkeypatch):
    pytest.importorskip("matplotlib")
    monkeypatch.setenv("MPLBACKEND", "agg")
    monkeypatch.setattr(sys, "argv", ["tour.py", str(tmp_path)])
    monkeypatch.setattr(sys, "path", [str(FOLDER / "examples"), *sys.path])
    output = io.StringIO()
    with contextlib.redirect_stdout(output):
        runpy.run_path(str(FOLDER / "examples" / "tour.py"))
    assert len(list(tmp_path.glob("?_*.png"))) == 5
    said = dict(re.findall(r"(corners off by at most|share of guesses that come back|texts mapped) ([\d.]+)",
                           output.getvalue()))
    assert float(said["corners off by at most"]) < 0.3, output.getvalue()
    assert float(said["share of guesses that come back"]) > 0.1, output.getvalue()
    assert float(said["texts mapped"]) >= 2, output.getvalue()
