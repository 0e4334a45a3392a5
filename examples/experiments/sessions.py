"""What the experiments with several sessions, or halves of one, share: rendered walks through a scene, and the programs
they call."""
import argparse
import json
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent


def parser_of(name, description):
    """A parser of the options that all of them have."""
    parser = argparse.ArgumentParser(prog=f"examples/experiments/{name}", description=description)
    add = parser.add_argument
    add("--programs", type=Path, default=ROOT / "build/release/bin", metavar="DIR",
        help="folder of textslam and textslam-eval (build/release/bin)")
    add("--output", type=Path, default=ROOT / "build" / name, metavar="DIR", help=f"results (build/{name})")
    return parser


def parser_for(name, description, kinds):
    """The same with those of rendered walks."""
    parser = parser_of(name, description)
    add = parser.add_argument
    add("--kinds", nargs="+", default=kinds, metavar="KIND", help=f"rendered kinds ({' '.join(kinds)})")
    add("--seeds", nargs="+", type=int, default=[1], metavar="N", help="their seeds (1)")
    add("--map-frames", type=int, metavar="N", help="frames of a first session (each kind's own)")
    add("--walk-frames", type=int, default=240, metavar="N", help="frames of a walk (240)")
    return parser


def call(*command):
    """The program's output. Ends the experiment where it fails."""
    words = [str(word) for word in command]
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    if done.returncode not in (0, 3):  # 3: no frame was found, which is a result
        sys.exit(f"{' '.join(words)}: {done.stderr.strip()}")
    return done.stdout


def first_session(options, kind, seed):
    """The folder of the run that made the map; a finished one is used again."""
    folder = options.output / f"{kind}_{seed}"
    if not (folder / "map.db").exists():
        length = ["--frames", options.map_frames] if options.map_frames else []
        call(options.programs / "textslam", "--render", kind, "--seed", seed, *length, "--no-report", "--output", folder,
             "--save-map", folder / "map.db")
    return folder


def another_walk(options, kind, seed, walk):
    """The folder of another walk through the same scene, rendered once."""
    folder = options.output / f"{kind}_{seed}_walk{walk}"
    if not (folder / "sequence/images.txt").exists():
        call(options.programs / "textslam", "--render", kind, "--seed", seed, "--walk", walk, "--frames",
             options.walk_frames, "--render-only", "--output", folder)
    return folder


def metrics_of(run):
    """What metrics.json of a run's folder says."""
    return json.loads((run / "metrics.json").read_text(encoding="utf-8"))
