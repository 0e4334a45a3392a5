"""The experiments with several sessions or halves of one, with stand-ins for textslam and textslam-eval whose numbers a
reader can check.

usage: sessions_experiments_test.py REPOSITORY
"""
import json
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

EXPERIMENTS = Path(sys.argv.pop(1)).resolve() / "examples/experiments"

# Of the rendered frames the even ones show OPEN, which is sign 0 and mapped, and all show EXIT, sign 1, which is not. A
# start is found from frame 2 on: by OPEN at even frames, else by points, where it shows no mapped sign.
TEXTSLAM = """#!/usr/bin/env python3
import json, sqlite3, sys
from pathlib import Path
arguments = sys.argv[1:]
value = lambda name: arguments[arguments.index(name) + 1] if name in arguments else None
output = Path(value("--output"))
box = lambda x, rest: ",".join(map(str, [x, 0, x + 40, 0, x + 40, 10, x, 10])) + "," + rest + "\\n"
if "--render-only" in arguments:
    sequence = output / "sequence"
    for folder in ("images", "detections", "truth/quads"):
        (sequence / folder).mkdir(parents=True)
    for name in ("images.txt", "camera.yaml", "groundtruth.txt"):
        (sequence / name).write_text("")
    for i in range(int(value("--frames"))):
        name = f"{i:06d}.txt"
        (sequence / "truth/quads" / name).write_text(box(0, "OPEN,0,1") + box(100, "EXIT,1,1"))
        (sequence / "detections" / name).write_text((box(4, "OPEN") if i % 2 == 0 else "") + box(100, "OPEN"))
    sys.exit(0)
output.mkdir(parents=True, exist_ok=True)
if "--localise" in arguments:
    first = int(value("--first"))
    by = "nothing" if first < 2 else "texts" if first % 2 == 0 else "points"
    (output / "localisation.csv").write_text("timestamp,found_by,points,texts,position_sigma\\n0,nothing,0,0,\\n0," + by + ",9,1,1\\n")
    sys.exit(0 if by != "nothing" else 3)
walk = int(str(output.parent).rsplit("walk", 1)[1]) if output.name != "room_1" else 0
(output / "metrics.json").write_text(json.dumps(
    {"coverage": 1, "trajectory": {"ate_rmse": 0.001 * (walk + 1)}, "text": {"matches": [{"text": 5, "sign": 0}]}}))
file = value("--save-map") or value("--map")
if file:
    database = sqlite3.connect(file)
    database.execute("create table if not exists keyframes (session)")
    database.executemany("insert into keyframes values (?)", [(walk + 1,)] * (4 - walk))
    database.commit()
"""

EVAL = """#!/usr/bin/env python3
import json, sys
from pathlib import Path
run = Path(sys.argv[1])
at = int(run.name[5:]) if run.name.startswith("start") else 7
print(json.dumps({"frames": 10, "localised": 0 if at < 2 else 2, "judged": 10, "first": at, "wrong": int(at == 3),
                  "position_median": 0.001 * at, "position_max": 0.002 * at, "position_rmse": 0.001 * at}))
"""


# A camera that moves to the right, by an eighth of what it sees a frame, and looks along +z. The map is twice as large as
# the truth, turned about z and moved. Its points are the cells' centres of frame 9, 10 m ahead, which that frame saw. Of
# the second half five frames are found, off by 1 to 5 mm.
HALVES = """#!/usr/bin/env python3
import sqlite3, sys
from pathlib import Path
arguments = sys.argv[1:]
value = lambda name: arguments[arguments.index(name) + 1]
output = Path(value("--output"))
output.mkdir(parents=True, exist_ok=True)
at = lambda x, y, z: (5 - 2 * y, 7 + 2 * x, 2 * z)
place = lambda i: (0.2 * i, 0.05 * (i % 3), 0.04 * (i % 2) * (i < 9))
pose = lambda i, off: f"{i}.0 " + " ".join(map(str, at(*place(i)[:2], place(i)[2] + off))) + " 0 0 0.70710678 0.70710678\\n"
if "--localise" in arguments:
    assert value("--first") == "10"
    (output / "trajectory.txt").write_text("".join(pose(10 + k, 0.001 * (k + 1)) for k in range(5)))
    sys.exit(0)
assert value("--last") == "9"
(output / "trajectory.txt").write_text("".join(pose(i, 0) for i in range(10)))
database = sqlite3.connect(value("--save-map"))
database.executescript("create table cameras (width, height, fx, fy, cx, cy); create table points (id, x, y, z);"
                       "create table observations (point, keyframe); create table keyframes (id, x, y, z);")
database.execute("insert into cameras values (640, 480, 4000, 4000, 320, 240)")
database.execute("insert into keyframes values (1, ?, ?, ?)", at(*place(9)))
for i in range(48):
    x, y = 0.2 * (i % 8 - 3.5), 0.2 * (i // 8 - 2.5)
    database.execute("insert into points values (?, ?, ?, ?)", (i, *at(place(9)[0] + x, y, 10)))
    database.execute("insert into observations values (?, 1)", (i,))
database.commit()
"""


class SecondHalf(unittest.TestCase):
    def test_frames_that_overlap_are_told_apart(self):
        folder = Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, folder)
        (folder / "textslam").write_text(HALVES, encoding="utf-8")
        (folder / "textslam").chmod(0o755)
        (folder / "images.txt").write_text("".join(f"{i}.0 {i}.png\n" for i in range(20)), encoding="utf-8")
        truth = [f"{i}.0 {0.2 * i} {0.05 * (i % 3)} {0.04 * (i % 2) * (i < 9)} 0 0 0 1\n" for i in range(20)]
        (folder / "groundtruth.txt").write_text("".join(truth), encoding="utf-8")
        done = subprocess.run([EXPERIMENTS / "second_half", folder, "--programs", folder, "--output", folder / "out"],
                              capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(done.stdout.splitlines()[2:],
                         ["| 0 to 5 % | 3 | 0 % | - | - | - |", "| 5 to 25 % | 1 | 0 % | - | - | - |",
                          "| 25 to 50 % | 2 | 50 % | 5.0 | 5.0 | 5.0 |", "| 50 to 100 % | 4 | 100 % | 2.5 | 2.7 | 4.0 |",
                          "| all that overlap | 6 | 83 % | 3.0 | 3.3 | 5.0 |", "| all | 10 | 50 % | 3.0 | 3.3 | 5.0 |"])


class Sessions(unittest.TestCase):
    def setUp(self):
        self.folder = Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder)
        for name, text in (("textslam", TEXTSLAM), ("textslam-eval", EVAL)):
            (self.folder / name).write_text(text, encoding="utf-8")
            (self.folder / name).chmod(0o755)

    def said(self, name, *arguments):
        done = subprocess.run([EXPERIMENTS / name, "--programs", self.folder, "--output", self.folder / "out", *arguments],
                              capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout

    def starts(self, *arguments):
        return self.said("second_session", "--kinds", "room", "--walks", "1", "--starts", "4", "--frames", "2",
                         "--walk-frames", "6", *arguments)

    def test_starts_are_counted(self):
        said = self.starts()
        self.assertIn("2 of 4 starts found, 1 with a wrong pose; of 3 that show a mapped sign 1 were found by their signs",
                      said)
        self.assertIn("4 poses; position error median 2.50 mm, largest 6.00 mm", said)
        lines = [json.loads(line) for line in (self.folder / "out/starts.jsonl").read_text().splitlines()]
        self.assertEqual([line["by"] for line in lines], [None, None, "texts", "points"])
        self.assertEqual([line["frames_with_signs"] for line in lines], [1, 1, 1, 0])

    def test_one_mapped_sign_is_left(self):
        self.starts("--one-sign")
        left = self.folder / "out/room_1_walk1/one_sign/detections"
        boxes = [(left / f"{i:06d}.txt").read_text() for i in range(6)]
        self.assertEqual(["4,0," in box and box.count("\n") == 1 for box in boxes], [True, False] * 3)
        self.assertEqual(boxes[1], "")
        self.assertTrue((self.folder / "out/starts_one_sign.jsonl").exists())

    def test_walks_may_be_of_another_kind(self):
        self.starts("--walk-kind", "night")
        self.assertTrue((self.folder / "out/night_1_walk1/sequence").exists())
        self.assertFalse((self.folder / "out/room_1_walk1").exists())

    def test_sessions_follow_each_other(self):
        rows = self.said("sessions_in_turn", "--sessions", "3", "--night", "2", "--walk-frames", "6").splitlines()[2:]
        cells = [[cell.strip(" `") for cell in row.strip("|").split("|")] for row in rows]
        self.assertEqual([row[:7] for row in cells],
                         [["room` 1", "1", "room", "100 %", "1.00", "1.00", "4"],
                          ["room` 1", "2", "night", "100 %", "7.00", "2.00", "3"],
                          ["room` 1", "3", "room", "100 %", "7.00", "3.00", "2"]])


if __name__ == "__main__":
    unittest.main()
