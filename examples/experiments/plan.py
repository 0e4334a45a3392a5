"""What runs: cases, which are rendered sequences or a given one, and the modes on each.

A case is rendered once and runs in every mode, so that all modes see the same images and detections.
"""
MODES = ("text", "points", "loose")
KINDS = ("room", "corridor", "rapid", "lights", "sparse", "loop", "notext")
SEEDS = (1, 2, 3)
# First frames of the runs on a real sequence. There is only one, and its first frame changes every number by chance.
STARTS = (0, 3, 6, 9, 12, 15, 18, 21)

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
    """name: the folder in the output. group: `kinds`, `sequence` or the sweep's name. value: of the sweep. arguments:
    of the rendering, or of every run on a given sequence."""

    def __init__(self, name, group, kind, arguments=(), seed=None, value=None, sequence=None):
        self.name, self.group, self.kind = name, group, kind
        self.arguments, self.seed, self.value, self.sequence = list(arguments), seed, value, sequence


def cases(kinds, seeds, sweeps, frames, sequence):
    """The wanted cases, in the order of the report. frames: None for each kind's own length. sequence: a folder, or
    None."""
    length = ["--frames", str(frames)] if frames else []
    out = []
    for kind in kinds:
        for seed in seeds:
            arguments = ["--render", kind, "--seed", str(seed), *length]
            out.append(Case(f"{kind}-{seed}", "kinds", kind, arguments, seed=seed))
    if sequence:
        for first in STARTS:
            arguments = ["--first", str(first)] if first else []
            out.append(Case(f"sequence-{first}", "sequence", sequence.resolve().name, arguments, sequence=sequence))
    for sweep in sweeps:
        option, _, values = SWEEPS[sweep]
        for value in values:
            arguments = ["--render", SWEEP_KIND, "--seed", str(SWEEP_SEED), *length, option, str(value)]
            out.append(Case(f"{sweep}-{value}", sweep, SWEEP_KIND, arguments, seed=SWEEP_SEED, value=value))
    return out
