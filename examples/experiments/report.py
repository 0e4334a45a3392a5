"""docs/experiments.md from finished runs. The same programs give the same page, except its section on time."""
from figures import (
    ANGLE_BINS,
    LARGEST_ATE,
    LEAST_COVERAGE,
    angles,
    centres,
    failure,
    has_truth,
    histogram,
    mean,
    millimetres,
    quantile,
    signs_visible,
    text_count,
    trajectory_value,
    written,
)
from plan import MODES, STARTS, SWEEP_KIND, SWEEP_SEED, SWEEPS
from plot import plot
from tables import real_sequences, slow_sequences, table

WITH_PLANES = ("text", "loose")


def by_kind(cases):
    """[(name, cases)] of the rendered kinds and the real sequence, in order."""
    kinds = {}
    for case in cases:
        if case.group in ("kinds", "sequence"):
            kinds.setdefault((case.group, case.kind), []).append(case)
    return [(kind, group) for (_, kind), group in kinds.items()]


class Report:
    """results(case, mode) is the result of a run, or None if it has not run."""

    def __init__(self, cases, results, setting):
        self.cases, self.results, self.setting = cases, results, setting

    def runs(self, cases, mode):
        return [result for result in (self.results(case, mode) for case in cases) if result]

    def signs(self, cases, mode):
        """(mapped, visible, false texts) of the finished cases; visible is None where they show no signs. It comes from
        any mode, so that the signs of a run without a trajectory count too."""
        mapped = visible = strays = 0
        for case in cases:
            run = self.results(case, mode)
            told = [signs_visible(self.results(case, other)) for other in MODES]
            if run is None or not any(told):
                continue
            visible += next(count for count in told if count)
            mapped += text_count(run, "signs_mapped")
            strays += text_count(run, "false_texts")
        return mapped, visible or None, strays

    def text(self):
        real = [case for case in self.cases if case.group in ("sequence", "excerpt")]
        parts = [self.head(), self.accuracy(), real_sequences(real, self.runs), slow_sequences(self.cases, self.runs),
                 self.live(), self.planes(), self.angle_histogram(), self.time()]
        parts += [self.sweep(name) for name in SWEEPS if self.sweep_cases(name)]
        return "\n".join(part for part in parts + [self.failures()] if part)

    def head(self):
        setting = self.setting
        length = f"{setting['frames']} frames" if setting["frames"] else "each kind's own length"
        seeds, starts = (", ".join(map(str, numbers)) for numbers in (setting["seeds"], STARTS))
        coverage, largest = f"{100 * LEAST_COVERAGE:.0f} %", f"{100 * LARGEST_ATE:.0f} %"
        return f"""# Experiments

Written by `examples/experiments/run`. `textslam` runs in three modes on rendered sequences of
{length} (640x480, exact truth), with the seeds {seeds}. If the folder of a real sequence is
given, it also runs on that, from the frames {starts} on if no others are given.

- `text`: points and text planes in one cost, the paper's method;
- `points`: points alone;
- `loose`: as `points`; three-point RANSAC fits a plane to the map points in a text's quad, the paper's comparison.

ATE is the absolute trajectory error (the paper's APE): rms after Sim(3) alignment. RPE is the relative error over
0.1 m of path, rms. `live` is the ATE of the poses as known when their frames were processed.
In `cuts` 60 frames show another place, and in `covered` 30 show nothing: these can have no pose.

A run has failed if the program does not end well, if fewer than {coverage} of the frames have a pose, or if ATE is
above {largest} of the path. A failed run counts in no mean, its signs count as not mapped, and the end of the page
lists it.
"""

    def accuracy(self):
        rows = []
        for kind, cases in by_kind(self.cases):
            for mode in MODES:
                rows += self.accuracy_row(kind, mode, self.runs(cases, mode))
        if not rows:
            return ""
        head = ["sequence", "mode", "ATE, mm", "mean", "% of path", "live", "RPE, mm", "RPE, deg", "frames with a pose",
                "failed"]
        return "## Trajectories (the paper's Table I)\n\n" + table(head, rows, 2)

    def live(self):
        """ATE of the final and the live poses of each run in mode `text`."""
        rows = []
        for kind, cases in by_kind(self.cases):
            for case in cases:
                run = self.results(case, "text")
                final = trajectory_value(run, "ate_rmse") if run else None
                live = trajectory_value(run, "ate_rmse", live=True) if run else None
                if final and live:
                    which = f"from frame {case.first}" if case.seed is None else f"seed {case.seed}"
                    rows.append([f"`{kind}`", which, millimetres(final), millimetres(live), written(live / final, 2)])
        if not rows:
            return ""
        return ("## Live poses\n\nATE of each run of mode `text`, in mm.\n\n"
                + table(["sequence", "", "final", "live", "live / final"], rows, 2))

    @staticmethod
    def accuracy_row(kind, mode, runs):
        if not runs:
            return []
        failed = sum(1 for run in runs if failure(run))
        coverage = mean([run["metrics"]["coverage"] for run in runs if run["metrics"]])
        covered = "-" if coverage is None else f"{100 * coverage:.1f} %"
        if not any(has_truth(run) for run in runs):
            return [[f"`{kind}`", mode, "no truth", *["-"] * 5, covered, f"{failed} of {len(runs)}"]]

        def values(name, live=False):
            found = [trajectory_value(run, name, live) for run in runs]
            return [value for value in found if value is not None]

        each = ["failed" if failure(run) else millimetres(trajectory_value(run, "ate_rmse")) for run in runs]
        paths = [trajectory_value(run, "path_length") for run in runs]
        shares = [100 * ate / path for ate, path in zip(values("ate_rmse"), [p for p in paths if p is not None])]
        return [[
            f"`{kind}`", mode, ", ".join(each), millimetres(mean(values("ate_rmse"))), written(mean(shares), 3),
            millimetres(mean(values("ate_rmse", live=True))),
            millimetres(mean(values("rpe_distance_translation_rmse"))),
            written(mean(values("rpe_distance_rotation_rmse_deg")), 3), covered, f"{failed} of {len(runs)}",
        ]]

    def planes(self):
        kinds = [(f"`{kind}`", cases) for kind, cases in by_kind(self.cases)]
        kinds.append(("all", [case for _, cases in kinds for case in cases]))
        rows = [self.plane_row(name, cases, mode) for name, cases in kinds for mode in WITH_PLANES
                if self.signs(cases, mode)[1] is not None]
        if not rows:
            return ""
        head = ["sequence", "mode", "angle median, deg", "p90", "largest", "centre median, mm", "p90", "signs mapped",
                "false texts"]
        title = "## Planes (the paper's Table II)\n\nErrors of the normals and centres of all mapped signs.\n\n"
        return title + table(head, rows, 2)

    def plane_row(self, name, cases, mode):
        runs = self.runs(cases, mode)
        errors, offsets = angles(runs), centres(runs)
        mapped, visible, strays = self.signs(cases, mode)
        return [
            name, mode, written(quantile(errors, 0.5), 2), written(quantile(errors, 0.9), 2),
            written(max(errors, default=None), 2), millimetres(quantile(offsets, 0.5), 1),
            millimetres(quantile(offsets, 0.9), 1),
            f"{mapped} of {visible}", str(strays),
        ]

    def angle_histogram(self):
        cases = [case for _, group in by_kind(self.cases) for case in group]
        counts = {mode: histogram(angles(self.runs(cases, mode))) for mode in WITH_PLANES}
        if not any(sum(count) for count in counts.values()):
            return ""
        names = [f"up to {end:g}" for end in ANGLE_BINS] + [f"above {ANGLE_BINS[-1]:g}"]
        rows = []
        for i, name in enumerate(names):
            row = [name]
            for mode in WITH_PLANES:
                share = counts[mode][i] / max(1, sum(counts[mode]))
                row += [str(counts[mode][i]), f"{100 * share:.0f} % " + "█" * round(20 * share)]
            rows.append(row)
        head = ["angle error, deg"] + [cell for mode in WITH_PLANES for cell in (mode, "share")]
        return "## Distribution of the angle errors\n\n" + table(head, rows)

    def time(self):
        rows = []
        for kind, cases in by_kind(self.cases):
            for mode in MODES:
                runs = [r for r in self.runs(cases, mode) if r["code"] == 0 and r["metrics"] and r["tracking_s"]]
                if not runs:
                    continue
                frames = sum(run["metrics"]["frames"] for run in runs)
                tracking, cpu = sum(run["tracking_s"] for run in runs), sum(run["cpu_s"] for run in runs)
                rows.append([f"`{kind}`", mode, f"{frames / tracking:.0f}", f"{1000 * cpu / frames:.1f}"])
        if not rows:
            return ""
        jobs = self.setting["jobs"]
        alone = "one run at a time" if jobs == 1 else f"{jobs} runs at a time, which slows each"
        head = ["sequence", "mode", "frames a second", "CPU ms a frame"]
        return f"""## Time

{self.setting['cpu']}, one thread a run, {alone}. "Frames a second" counts tracking,
mapping and local adjustment. "CPU" is the whole program, with reading images, filling in and the last
adjustment.

""" + table(head, rows, 2)

    def sweep_cases(self, name):
        cases = [case for case in self.cases if case.group == name]
        return [case for case in cases if any(self.results(case, mode) for mode in MODES)]

    def sweep(self, name):
        rows, ate, angle = [], {mode: [] for mode in MODES}, {mode: [] for mode in WITH_PLANES}
        for case in self.sweep_cases(name):
            row = [f"{case.value:g}"]
            for mode in MODES:
                run = self.results(case, mode)
                value = run and trajectory_value(run, "ate_rmse")
                ate[mode].append((case.value, value and 1000 * value))
                row.append("-" if not run else "failed" if failure(run) else millimetres(value))
            for mode in WITH_PLANES:
                errors = angles(self.runs([case], mode))
                angle[mode].append((case.value, quantile(errors, 0.5)))
                mapped, visible, _ = self.signs([case], mode)
                row += ["-" if visible is None else f"{mapped} of {visible}",
                        written(quantile(errors, 0.5), 2), written(quantile(errors, 0.9), 2)]
            rows.append(row)
        unit = SWEEPS[name][1]
        picture = f"experiments_{name}.svg"
        self.setting["pictures"][picture] = plot(unit, [("ATE, mm", ate), ("angle error, median, deg", angle)])
        head = [unit] + [f"ATE {mode}, mm" for mode in MODES]
        for mode in WITH_PLANES:
            head += [f"signs mapped, {mode}", "angle median, deg", "p90"]
        title = f"## Sweep: {unit}\n\n`{SWEEP_KIND}`, seed {SWEEP_SEED}, `{SWEEPS[name][0]}`."
        return f"{title}\n\n![{unit}](images/{picture})\n\n" + table(head, rows)

    def failures(self):
        lines = []
        for case in self.cases:
            for mode in MODES:
                run = self.results(case, mode)
                if run and failure(run):
                    lines.append(f"- `{case.name}`, {mode}: {failure(run)}")
        return "## Runs that failed\n\n" + ("\n".join(lines) if lines else "None.") + "\n"
