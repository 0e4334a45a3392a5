#!/usr/bin/env python3
"""What a call from Python takes beside the same call from C++: docs/python.md, "Measured".

usage: PYTHONPATH=build/dev/python overhead.py PROGRAM   (PROGRAM: python_numbers of the same build)

Least of 300 short repetitions each, so that other programs disturb few; both take turns three times.
"""
import subprocess
import sys
import time

import scene

import textplane as tp

ARGUMENTS = scene.PATCH, scene.THETA, scene.GUESS, scene.PYRAMID, scene.CAMERA
CALLS = {
    "plane_homography": (500, lambda: tp.plane_homography(scene.THETA, scene.T_T_H)),
    "linearise_pose": (100, lambda: tp.linearise_pose(*ARGUMENTS)),
    "evaluate": (100, lambda: tp.evaluate(*ARGUMENTS)),
    "align_pose": (5, lambda: tp.align_pose(*ARGUMENTS)),
}


def ours(calls, function):
    least = float("inf")
    for _ in range(300):
        start = time.perf_counter_ns()
        for _ in range(calls):
            function()
        least = min(least, (time.perf_counter_ns() - start) / calls)
    return least


def main():
    if len(sys.argv) != 2:
        print(__doc__, file=sys.stderr)
        return 2
    python = {name: float("inf") for name in CALLS}
    cpp = dict(python)
    for _ in range(3):
        for line in subprocess.run([sys.argv[1], "time"], capture_output=True, text=True, check=True).stdout.splitlines():
            name, ns = line.split()
            cpp[name] = min(cpp[name], float(ns))
        for name, (calls, function) in CALLS.items():
            python[name] = min(python[name], ours(calls, function))
    print("| call | C++, us | Python, us | overhead, us | |\n| --- | ---: | ---: | ---: | ---: |")
    for name in CALLS:
        over = (python[name] - cpp[name]) / 1000
        print(f"| `{name}` | {cpp[name] / 1000:.2f} | {python[name] / 1000:.2f} | {over:.2f} | "
              f"{100 * over * 1000 / cpp[name]:+.1f} % |")
    return 0


if __name__ == "__main__":
    sys.exit(main())
