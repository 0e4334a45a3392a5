"""The experiments with a stand-in for textslam, whose numbers a reader can check against the report.

usage: experiments_test.py REPOSITORY
"""
import json
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(sys.argv.pop(1)).resolve()
sys.dont_write_bytecode = True
sys.path.insert(0, str(ROOT / "examples/experiments"))
import figures  # noqa: E402
import plan  # noqa: E402

# Renders a file that holds its arguments, and finds errors that depend on mode, seed and condition; seed 3 fails in mode points.
STAND_IN = """#!/usr/bin/env python3
import json, os, sys
arguments = sys.argv[1:]
value = lambda name: arguments[arguments.index(name) + 1] if name in arguments else None
output = value("--output")
with open(os.environ["CALLS"], "a") as calls:
    calls.write(" ".join(arguments) + "\\n")
if "--render-only" in arguments:
    os.makedirs(output + "/sequence")
    json.dump({"seed": int(value("--seed")), "blur": float(value("--blur") or 0)}, open(output + "/sequence/frames", "w"))
    sys.exit(0)
frames = json.load(open(arguments[0] + "/frames"))
mode = value("--mode")
if frames["seed"] == 3 and mode == "points":
    sys.exit("textslam: out of luck")
ate = 0.001 * frames["seed"] * {"text": 1, "points": 2, "loose": 2}[mode]
errors = {"status": "ok", "path_length": 5, "ate_rmse": ate, "rpe_distance_translation_rmse": 0.0005,
          "rpe_distance_rotation_rmse_deg": 0.02}
ate *= int(value("--every") or 1)
errors["ate_rmse"] = ate
metrics = {"frames": 10, "tracked": 10, "coverage": 0.3 if frames["blur"] > 9 else 1.0, "trajectory": errors,
           "trajectory_live": {**errors, "ate_rmse": 2 * ate}, "tracked_live": 6, "maps": 1 + int(value("--first") or 0),
           "map_began_at_frame": 5 + int(value("--first") or 0),
           "filled_in": {"poses": 4, "ate_rmse": 3 * ate}}
if mode == "text" and frames["blur"] > 29:
    errors["status"] = "too_few"
elif mode == "points":
    metrics["text"] = {"signs_visible": 3, "signs_mapped": 0, "false_texts": 0, "matches": []}
else:
    turn = {"text": 1, "loose": 4}[mode]
    metrics["text"] = {"signs_visible": 3, "signs_mapped": 2, "false_texts": 1, "matches": [
        {"sign": 0, "angle_deg": 0.2 * turn, "centre": 0.01}, {"sign": 1, "angle_deg": 0.6 * turn, "centre": 0.03},
        {"sign": -1, "angle_deg": 90, "centre": 9}]}
json.dump(metrics, open(output + "/metrics.json", "w"))
json.dump({"frames": [{"tracking": 3, "mapping": 1}] * 10}, open(output + "/timing.json", "w"))
"""


class Figures(unittest.TestCase):
    def test_quantiles_lie_between_their_neighbours(self):
        self.assertEqual(figures.quantile([4, 1, 3, 2], 0.5), 2.5)
        self.assertAlmostEqual(figures.quantile([4, 1, 3, 2], 0.9), 3.7)
        self.assertIsNone(figures.quantile([], 0.5))

    def test_bins_hold_their_upper_end(self):
        self.assertEqual(figures.histogram([0.1, 0.25, 0.3, 10, 11]), [2, 1, 0, 0, 0, 1, 1])


class Experiments(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.addCleanup(self.temporary.cleanup)
        self.folder = Path(self.temporary.name)
        self.program = self.folder / "textslam"
        self.program.write_text(STAND_IN)
        self.program.chmod(0o755)
        self.calls = self.folder / "calls"

    def run_part(self, *arguments):
        """The report; self.called holds the calls of this time."""
        self.calls.write_text("")
        command = [str(ROOT / "examples/experiments/run"), "--textslam", str(self.program), "--output", str(self.folder / "out"),
                   "--report", str(self.folder / "report.md"), *arguments]
        self.outcome = subprocess.run(command, capture_output=True, text=True, env={"PATH": "/usr/bin:/bin", "CALLS": str(self.calls)})
        self.assertEqual(self.outcome.returncode, 0, self.outcome.stderr)
        self.called = self.calls.read_text().splitlines()
        return (self.folder / "report.md").read_text()

    def test_report_by_hand(self):
        report = self.run_part("--kinds", "room", "--seeds", "1", "2", "3", "--sweeps", "--frames", "10", "--jobs", "2")
        self.assertEqual(len(self.called), 12)  # three renderings, three modes on each
        self.assertIn("| `room` | text | 1.00, 2.00, 3.00 | 2.00 | 0.040 | 4.00 | 0.50 | 0.020 | 100.0 % | 0 of 3 |", report)
        self.assertIn("| `room` | points | 2.00, 4.00, failed | 3.00 | 0.060 | 6.00 | 0.50 | 0.020 | 100.0 % | 1 of 3 |", report)
        self.assertIn("- `room-3`, points: exit code 1: textslam: out of luck", report)
        self.assertIn("| `room` | seed 2 | 2.00 | 4.00 | 2.00 |", report)
        # 0.2, 0.2, 0.2, 0.6, 0.6, 0.6 degrees, and four times that
        self.assertIn("| `room` | text | 0.40 | 0.60 | 0.60 | 20.0 | 30.0 | 6 of 9 | 3 |", report)
        self.assertIn("| all | loose | 1.60 | 2.40 | 2.40 | 20.0 | 30.0 | 6 of 9 | 3 |", report)
        self.assertIn("| up to 0.25 | 3 | 50 % ██████████ | 0 | 0 %  |", report)
        self.assertIn("| `room` | text | 250 |", report)  # 4 ms a frame
        self.assertEqual(list((self.folder / "out").glob("frames/*")), [], "rendered frames are deleted")

    def test_finished_runs_are_kept_until_the_program_changes(self):
        part = ("--kinds", "room", "--seeds", "2", "3", "--sweeps", "--frames", "10")
        first = self.run_part(*part)
        again = self.run_part(*part)
        self.assertEqual(self.called, [])
        self.assertEqual(first, again)
        (self.folder / "out/runs/room-2/loose/result.json").unlink()  # as if broken off
        self.run_part(*part)
        self.assertEqual([call.split()[-3:-1] for call in self.called if "--mode" in call], [["loose", "--output"]])
        self.run_part(*part, "--retry-failed")
        self.assertEqual([call.split()[-3] for call in self.called if "--mode" in call], ["points"])
        self.program.write_text(STAND_IN + "\n")
        self.run_part(*part)
        self.assertEqual(len(self.called), 8)

    def test_kept_frames_serve_a_changed_program(self):
        part = ("--kinds", "room", "--seeds", "1", "--sweeps", "--frames", "10", "--keep-frames")
        self.run_part(*part)
        self.program.write_text(STAND_IN + "\n")
        self.run_part(*part)
        self.assertEqual(len(self.called), 3, "three modes, no rendering")
        self.run_part(*part[:-3], "--frames", "11", "--keep-frames")
        self.assertEqual(len(self.called), 4, "other frames")

    def test_sweep_shows_failing_runs_and_draws_them(self):
        report = self.run_part("--kinds", "--sweeps", "blur", "--frames", "10")
        self.assertEqual(len(self.called), 4 * len(plan.SWEEPS["blur"][2]))
        self.assertIn("| 8 | 1.00 | 2.00 | 2.00 | 2 of 3 | 0.40 | 0.56 | 2 of 3 | 1.60 | 2.24 |", report)
        self.assertIn("| 30 | failed | failed | failed | 0 of 3 | - | - | 0 of 3 | - | - |", report)
        self.assertIn("- `blur-30`, loose: 30 % of the frames have a pose", report)
        picture = (self.folder / "images/experiments_blur.svg").read_text()
        self.assertEqual(picture.count("<circle"), 4 * 5)  # ATE of three modes, angles of two
        self.assertEqual(picture.count("l8 8m0 -8l-8 8"), 5 * 5)

    def test_a_missing_sequence_is_left_out_with_a_line(self):
        report = self.run_part("--kinds", "--sweeps", "--sequence", str(self.folder / "none"))
        self.assertIn("no such folder, left out", self.outcome.stdout)
        self.assertNotIn("`none`", report)

    def test_a_real_sequence_is_run_where_it_is(self):
        (self.folder / "real").mkdir()
        (self.folder / "real/frames").write_text(json.dumps({"seed": 1, "blur": 0}))
        report = self.run_part("--kinds", "--sweeps", "--sequence", str(self.folder / "real"))
        self.assertEqual(len(self.called), 3 * len(plan.STARTS))
        self.assertEqual(sum("--first 3 --detector classical --mode" in call for call in self.called), 3)
        self.assertIn("| `real` | text | 1.00, 1.00, ", report)
        self.assertTrue((self.folder / "real/frames").exists())

    def test_several_real_sequences_each_with_its_starts(self):
        for name, blur in (("a/real", 0), ("b/real", 10), ("c", 0)):
            (self.folder / name).mkdir(parents=True)
            (self.folder / name / "frames").write_text(json.dumps({"seed": 1, "blur": blur}))
        (self.folder / "c/detections").mkdir()
        report = self.run_part("--kinds", "--sweeps", "--sequence", f"{self.folder}/a/real@0,3-8,6-9", "--sequence",
                               f"{self.folder}/b/real@1", "--sequence", f"{self.folder}/c@0", "--jobs", "2")
        self.assertEqual(len(self.called), 3 * 5)
        self.assertEqual(sum("a/real --first 3 --last 8 --detector classical --mode" in call for call in self.called), 3)
        self.assertEqual(sum(f"{self.folder}/c --mode" in call for call in self.called), 3, "it has detections")
        # ATE 1 mm (points 2) final, twice that live, three times filled in, of a path of 5 m; a map more with each first frame
        self.assertIn("| `a-real` | text | 1 of 1 | 100.0 % | 60.0 % | 1.0 | 5 | 1.0 | 0.02 | 0.02 | 2.0 | 3.0 |  |", report)
        self.assertIn("| `a-real`, excerpts | text | 2 of 2 | 100.0 % | 60.0 % | 5.5 | 11 | 1.0 | 0.02 | 0.02 | 2.0 | 3.0 |  |", report)
        self.assertIn("| `a-real`, excerpts | points | 2 of 2 | 100.0 % | 60.0 % | 5.5 | 11 | 2.0 | 0.04 | 0.04 | 4.0 | 6.0 |  |", report)
        self.assertEqual(report.count("| `a-real`, excerpts | text |"), 1, "excerpts are in one table alone")
        # Too few frames to count above, and here with what they are worth.
        self.assertIn("| `b-real` | text | 1 of 1 | 30.0 % | 60.0 % | 2.0 | 6 | 1.0 | 0.02 | 0.02 | 2.0 | 3.0 |  |", report)
        self.assertIn("- `sequence-b-real-1`, text: 30 % of the frames have a pose", report)

    def test_fewer_frames_a_second_share_the_rendering(self):
        report = self.run_part("--kinds", "room", "rapid", "--seeds", "1", "2", "--sweeps", "--frames", "10", "--every", "6", "10")
        self.assertEqual(sum("--render-only" in call for call in self.called), 4)
        self.assertEqual(sum("--every 6" in call for call in self.called), 6, "rapid is not among them")
        self.assertIn("| `room` | 6 | text | 6.00, 12.00 | 9.00 | 6.00 | 100.0 % | 1.0 | 0 of 2 |", report)
        self.assertIn("| `room` | 10 | points | 20.00, 40.00 | 30.00 | 10.00 | 100.0 % | 1.0 | 0 of 2 |", report)
        self.assertIn("| `room` | text | 1.00, 2.00 | 1.50 |", report)
        self.assertNotIn("| `rapid` | 6 |", report)


if __name__ == "__main__":
    unittest.main()
