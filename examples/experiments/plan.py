"""What runs: cases, which are rendered sequences or a given one, and the modes on each.

A case is rendered once and runs in every mode, so that all modes see the same images and detections. Cases of one
rendering at several frame rates share it.
"""
import re
from pathlib import Path

MODES = ("text", "points", "loose")
KINDS = ("room", "corridor", "rapid", "lights", "night", "sparse", "loop", "notext", "crowd", "cuts", "covered", "fisheye",
         "shutter")
SEEDS = (1, 2, 3)
# First frames of the runs on a real sequence: there is only one of it, and its first frame changes every number by chance.
STARTS = (0, 3, 6, 9, 12, 15, 18, 21)
# The rendered kinds that also run with fewer frames a second.
SLOW_KINDS = ("room", "corridor", "loop")

# A sweep varies one condition of the room: the option of textslam, its unit, and the values.
SWEEPS = {
    "blur": ("--blur", "px of motion blur", (0, 2, 4, 8, 12, 16, 20, 25, 30)),
    "gain": ("--gain", "gain of the sensor", (0.3, 0.5, 0.75, 1, 1.25, 1.5, 2)),
    "noise": ("--noise", "grey levels of noise, one sigma", (0, 2, 4, 6, 8, 10, 12, 15)),
    "jitter": ("--jitter", "px of jitter of detections, one sigma", (0, 1, 2, 3, 4, 6, 8)),
    "missed": ("--missed", "share of missed detections", (0, 0.2, 0.4, 0.6, 0.8, 0.9, 1)),
    "false": ("--false", "false detections a frame", (0, 0.1, 0.5, 1, 2, 4)),
}
SWEEP_KIND = "room"
SWEEP_SEED = 1


class Case:
    """name: the folder in the output. group: `kinds`, `every`, `sequence`, `excerpt` (of a real sequence) or the sweep's
    name. value: of the sweep, or the frames of which one is used. rendering: its arguments; empty for a real sequence.
    arguments: of every run. first: frame of a real sequence."""

    def __init__(self, name, group, kind, rendering=(), arguments=(), seed=None, value=None, sequence=None, first=None):
        self.name, self.group, self.kind = name, group, kind
        self.rendering, self.arguments = list(rendering), list(arguments)
        self.seed, self.value, self.sequence, self.first = seed, value, sequence, first


class RealSequence:
    """A folder and the runs on it, [(first frame, last frame or None)]. Written `DIR`, for those of STARTS, or
    `DIR@0,30-129`."""

    def __init__(self, text):
        folder, mark, runs = text.rpartition("@")
        if mark and re.fullmatch(r"\d+(-\d+)?(,\d+(-\d+)?)*", runs) and not Path(text).is_dir():
            ends = [run.partition("-")[::2] for run in runs.split(",")]
            self.folder, self.runs = Path(folder), [(int(first), int(last) if last else None) for first, last in ends]
        else:
            self.folder, self.runs = Path(text), [(first, None) for first in STARTS]

    def cases(self, kind):
        out = []
        # The built-in detector where the sequence has no detections of its own.
        detector = [] if (self.folder / "detections").is_dir() else ["--detector", "classical"]
        for first, last in self.runs:
            arguments = ["--first", str(first)] if first else []
            arguments += ["--last", str(last)] if last is not None else []
            name = f"sequence-{kind}-{first}" + (f"-{last}" if last is not None else "")
            group = "sequence" if last is None else "excerpt"
            out.append(Case(name, group, kind, (), arguments + detector, sequence=self.folder, first=first))
        return out


def names_of(sequences):
    """The names of their folders; where two have the same, with the folder above."""
    folders = [sequence.folder.resolve() for sequence in sequences]
    last = [folder.name for folder in folders]
    return [f"{folder.parent.name}-{folder.name}" if last.count(folder.name) > 1 else folder.name for folder in folders]


def cases(kinds, seeds, sweeps, frames, sequences=(), every=()):
    """The wanted cases, in the order of the report. frames: None for each kind's own length. every: of SLOW_KINDS among
    the kinds, one frame of so many is used."""
    length = ["--frames", str(frames)] if frames else []
    out = []
    for kind in kinds:
        for seed in seeds:
            rendering = ["--render", kind, "--seed", str(seed), *length]
            out.append(Case(f"{kind}-{seed}", "kinds", kind, rendering, seed=seed))
            for step in every if kind in SLOW_KINDS else ():
                out.append(Case(f"{kind}-{seed}-every-{step}", "every", kind, rendering, ["--every", str(step)], seed,
                                step))
    for sequence, name in zip(sequences, names_of(sequences)):
        out += sequence.cases(name)
    for sweep in sweeps:
        option, _, values = SWEEPS[sweep]
        for value in values:
            rendering = ["--render", SWEEP_KIND, "--seed", str(SWEEP_SEED), *length, option, str(value)]
            out.append(Case(f"{sweep}-{value}", sweep, SWEEP_KIND, rendering, seed=SWEEP_SEED, value=value))
    return out
