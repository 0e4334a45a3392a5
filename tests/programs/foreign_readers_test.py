#!/usr/bin/env python3
"""Outputs of textslam, read by programs that are not ours: PLY by meshio, TUM by the rules of its own description.

usage: foreign_readers_test.py TEXTSLAM

Exit code 77: no meshio for any Python here (Debian: python3-meshio).
"""
import json
import math
import pathlib
import subprocess
import sys
import tempfile


def use_python_with_meshio():
    """Debian's modules belong to Debian's Python, which need not be the one that runs this."""
    try:
        import meshio  # noqa: F401
    except ImportError:
        debian = "/usr/bin/python3"
        knows = [debian, "-c", "import meshio"]
        if sys.executable == debian or not pathlib.Path(debian).exists() or subprocess.run(knows, capture_output=True).returncode:
            print("no meshio (Debian: python3-meshio)")
            sys.exit(77)
        sys.exit(subprocess.run([debian, *sys.argv]).returncode)


def expect(condition, what):
    if not condition:
        sys.exit(f"FAILED: {what}")


def check_ply(folder):
    import meshio

    mesh = meshio.read(folder / "text_map.ply")
    texts = json.loads((folder / "text_map.json").read_text())["texts"]
    metrics = json.loads((folder / "metrics.json").read_text())
    expect(len(texts) > 0, "the map has texts")
    expect(len(mesh.points) == 4 * len(texts) + metrics["points"] + metrics["keyframes"], "all vertices are there")
    faces = [cells.data for cells in mesh.cells if cells.type == "quad"]
    expect(len(faces) == 1 and len(mesh.cells) == 1, "the faces are quads")
    expect(len(faces[0]) == len(texts), "a face a text")
    for text, face in zip(texts, faces[0]):
        for corner, index in zip(text["corners"], face):
            expect(math.dist(corner, mesh.points[index]) < 1e-5 * (1 + math.hypot(*corner)), f"corners of text {text['id']}")
    colours = list(zip(*(mesh.point_data[name].tolist() for name in ("red", "green", "blue"))))
    expect(all(colour == (30, 90, 220) for colour in colours[: 4 * len(texts)]), "texts are blue")
    expect(colours.count((150, 150, 150)) == metrics["points"], "points are grey")
    expect(colours.count((240, 140, 20)) == metrics["keyframes"], "key frames are orange")


def check_tum(path, count):
    """`timestamp tx ty tz qx qy qz qw` a line, blanks between, times rising, quaternions of length 1."""
    before = -math.inf
    rows = 0
    for number, line in enumerate(path.read_text(encoding="ascii").splitlines(), 1):
        if line.startswith("#"):
            continue
        values = [float(word) for word in line.split(" ")]
        expect(len(values) == 8 and all(math.isfinite(value) for value in values), f"{path}:{number}: eight numbers")
        expect(values[0] > before, f"{path}:{number}: times rise")
        expect(abs(math.hypot(*values[4:]) - 1) < 1e-6, f"{path}:{number}: a unit quaternion")
        before = values[0]
        rows += 1
    expect(rows == count, f"{path}: {count} poses, not {rows}")


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    use_python_with_meshio()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name) / "out"
        command = [sys.argv[1], "--render", "room", "--frames", "80", "--no-report", "--output", str(folder)]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
        metrics = json.loads((folder / "metrics.json").read_text())
        check_ply(folder)
        check_tum(folder / "trajectory.txt", metrics["tracked"])
        check_tum(folder / "trajectory_live.txt", metrics["tracked_live"])
        check_tum(folder / "keyframes.txt", metrics["keyframes"])
    print("meshio and the rules of TUM agree with the outputs")


if __name__ == "__main__":
    main()
