"""Poses to date: how much of the error of live poses comes from what was yet to be seen.

A live pose rests on what was seen until its frame. Here textslam is run on the first frames alone, some further each time and each
time to its end, that is with the adjustment of everything, and of each such run the poses of its newest frames are taken. What these
are off cannot be mended by adjusting more or later on the way.
"""
import csv
import subprocess

STEP = 20  # frames from run to run


def newest_poses(path, after):
    """Lines of a trajectory with a time beyond `after`."""
    if not path.exists():
        return []
    lines = [line for line in path.read_text(encoding="utf-8").splitlines() if line and not line.startswith("#")]
    return [line for line in lines if float(line.split()[0]) > after]


def measure(textslam, sequence, frames, folder, call):
    """ATE of the poses to date of a sequence, m; None where there are too few of them. `call`: of execute.py."""
    poses, last = [], float("-inf")
    for end in [*range(STEP, frames, STEP), frames]:
        part = folder / f"first-{end}"
        call([str(textslam), str(sequence), "--last", str(end - 1), "--no-report", "--output", str(part)])
        fresh = newest_poses(part / "trajectory.txt", last)
        if fresh:
            poses, last = poses + fresh, float(fresh[-1].split()[0])
    whole = folder / "whole"
    whole.mkdir(parents=True, exist_ok=True)
    (whole / "trajectory.txt").write_text("\n".join(poses) + "\n", encoding="utf-8")
    command = [str(textslam.parent / "textslam-eval"), str(whole), "--truth", str(sequence), "--csv"]
    evaluation = subprocess.run(command, capture_output=True, text=True, check=False)
    rows = list(csv.DictReader(evaluation.stdout.splitlines())) if evaluation.returncode == 0 else []
    return float(rows[0]["ate_rmse"]) if rows and rows[0]["status"] == "ok" else None
