"""Tables of the report beside those of the rendered kinds: real sequences, and lower frame rates."""
from figures import aligned, failure, mean, millimetres, trajectory_value, written
from plan import MODES


def table(head, rows, names=1):
    """Markdown; the first `names` columns are names, the others numbers."""
    align = ["---"] * names + ["---:"] * (len(head) - names)
    lines = ["| " + " | ".join(cells) + " |" for cells in [head, align, *rows]]
    return "\n".join(lines) + "\n"


def shares(metrics):
    """Of the frames: those with a pose, and those with a live one."""
    return metrics["coverage"], metrics.get("tracked_live", 0) / max(1, metrics["frames"])


def error_cells(runs, name):
    """ATE in mm and in % of the true path, means of the runs that have it."""
    found = [aligned(run, name) for run in runs]
    errors = [errors["ate_rmse"] for errors in found if errors]
    paths = [aligned(run, "trajectory") for run, errors in zip(runs, found) if errors]
    percent = [100 * e / path["path_length"] for e, path in zip(errors, paths) if path and path["path_length"] > 0]
    return [millimetres(mean(errors)), written(mean(percent), 3)]


def real_row(kind, mode, runs):
    measured = [run for run in runs if run["metrics"]]
    if not measured:
        return [[f"`{kind}`", mode, f"0 of {len(runs)}", *["-"] * 9]]
    covered, live = zip(*[shares(run["metrics"]) for run in measured])
    maps = [run["metrics"].get("maps", 0) for run in measured]
    return [[
        f"`{kind}`", mode, f"{len(measured)} of {len(runs)}", f"{100 * mean(covered):.1f} %", f"{100 * mean(live):.1f} %",
        written(mean(maps), 1), *error_cells(measured, "trajectory"), *error_cells(measured, "trajectory_live"),
        *error_cells(measured, "filled_in"),
    ]]


def real_sequences(groups, runs):
    """groups: [(name, cases)]; runs(cases, mode): their results."""
    rows = [row for kind, cases in groups for mode in MODES if runs(cases, mode)
            for row in real_row(kind, mode, runs(cases, mode))]
    if not rows:
        return ""
    head = ["sequence", "mode", "runs", "frames with a pose", "with a live one", "maps", "ATE, mm", "% of path", "live, mm",
            "%", "filled in, mm", "%"]
    return """## Real sequences

Means over the starting frames. `live`: the poses as known when their frames were processed. `filled in`: the final
poses of the other frames, compared by the alignment of all. Errors are those of the frames that have a pose, also where
few have one: the first columns say how many.

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
