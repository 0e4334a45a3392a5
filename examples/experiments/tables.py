"""Tables of the report beside those of the rendered kinds: real sequences, and lower frame rates."""
import json
from pathlib import Path

from figures import aligned, failure, mean, median, millimetres, trajectory_value, written
from plan import MODES


def table(head, rows, names=1):
    """Markdown; the first `names` columns are names, the others numbers."""
    align = ["---"] * names + ["---:"] * (len(head) - names)
    lines = ["| " + " | ".join(cells) + " |" for cells in [head, align, *rows]]
    return "\n".join(lines) + "\n"


def shares(metrics):
    """Of the frames: those with a pose, and those with a live one."""
    return metrics["coverage"], metrics.get("tracked_live", 0) / max(1, metrics["frames"])


def errors_of(runs, name):
    """ATE in m and in % of the true path, of the runs that have it."""
    found = [(aligned(run, name), aligned(run, "trajectory")) for run in runs]
    found = [(errors["ate_rmse"], whole["path_length"]) for errors, whole in found if errors and whole]
    return [error for error, _ in found], [100 * error / path for error, path in found if path > 0]


def real_row(name, mode, runs, middle, peer):
    """middle: of several runs, the mean or the median."""
    measured = [run for run in runs if run["metrics"]]
    if not measured:
        return [name, mode, f"0 of {len(runs)}", *["-"] * 9, peer]
    covered, live = zip(*[shares(run["metrics"]) for run in measured])
    maps = [run["metrics"].get("maps", 0) for run in measured]
    began = [run["metrics"].get("map_began_at_frame", -1) for run in measured]
    errors, percent = errors_of(measured, "trajectory")
    return [
        name, mode, f"{len(measured)} of {len(runs)}", f"{100 * mean(covered):.1f} %", f"{100 * mean(live):.1f} %",
        written(mean(maps), 1), str(max(began) if min(began) >= 0 else "never"), millimetres(middle(errors), 1),
        written(middle(percent), 2), written(max(percent, default=None), 2),
        millimetres(middle(errors_of(measured, "trajectory_live")[0]), 1),
        millimetres(middle(errors_of(measured, "filled_in")[0]), 1), peer,
    ]


def real_sequences(cases, runs):
    """cases: of real sequences and their excerpts; runs(cases, mode): their results."""
    peers = json.loads((Path(__file__).parent / "peers.json").read_text(encoding="utf-8"))
    rows = []
    for kind, group in dict.fromkeys((case.kind, case.group) for case in cases):
        some = [case for case in cases if (case.kind, case.group) == (kind, group)]
        excerpts = group == "excerpt"
        rows += [real_row(f"`{kind}`" + (", excerpts" if excerpts else ""), mode, runs(some, mode),
                          median if excerpts else mean, "" if excerpts or mode != "text" else peers.get(kind, ""))
                 for mode in MODES if runs(some, mode)]
    if not rows:
        return ""
    head = ["sequence", "mode", "runs", "frames with a pose", "with a live one", "maps", "map begun by frame", "ATE, mm",
            "% of path", "worst", "live, mm", "filled in, mm", "ORB-SLAM3, whole sequence"]
    return """## Real sequences

Means over the starting frames; of excerpts, medians. `live`: the poses as known when their frames were processed.
`filled in`: the final poses of the other frames, compared by the alignment of all. Errors are those of the frames that
have a pose, also where few have one. A sequence without detections runs with the built-in detector. ORB-SLAM3's figures
were measured once, on whole sequences of which only parts are open to the developers, and are no output of this command.

""" + table(head, rows, 2)


def slow_row(kind, mode, step, runs, full):
    failed = sum(1 for run in runs if failure(run))
    ates = [trajectory_value(run, "ate_rmse") for run in runs]
    whole = [trajectory_value(run, "ate_rmse") for run in full]
    ate, base = (mean([value for value in values if value is not None]) for values in (ates, whole))
    coverage = mean([run["metrics"]["coverage"] for run in runs if run["metrics"]])
    maps = mean([run["metrics"].get("maps", 0) for run in runs if run["metrics"]])
    return [
        f"`{kind}`", str(step), mode, ", ".join("failed" if failure(r) else millimetres(v) for r, v in zip(runs, ates)),
        millimetres(ate), written(ate / base if ate and base else None, 2),
        "-" if coverage is None else f"{100 * coverage:.1f} %", written(maps, 1), f"{failed} of {len(runs)}",
    ]


def slow_sequences(cases, runs):
    """The cases that use one frame of several, beside those of the same kinds that use all."""
    rows = []
    slow = [case for case in cases if case.group == "every"]
    for kind, step in dict.fromkeys((case.kind, case.value) for case in slow):
        for mode in MODES:
            some = runs([case for case in slow if (case.kind, case.value) == (kind, step)], mode)
            full = runs([case for case in cases if case.group == "kinds" and case.kind == kind], mode)
            if some:
                rows.append(slow_row(kind, mode, step, some, full))
    if not rows:
        return ""
    head = ["sequence", "one frame of", "mode", "ATE, mm", "mean", "times that of all frames", "frames with a pose", "maps",
            "failed"]
    return "## Fewer frames a second\n\nThe rendered sequences have 30.\n\n" + table(head, rows, 3)
