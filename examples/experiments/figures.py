"""Numbers of finished runs: which failed and why, statistics over several, and how numbers are written."""

LEAST_COVERAGE = 0.5  # of the frames
LARGEST_ATE = 0.05  # of the path
ANGLE_BINS = (0.25, 0.5, 1, 2, 5, 10)  # degrees; upper ends, as in textslam-eval


def quantile(values, share):
    """Interpolated between the neighbouring values, as in metrics.json; None if there are no values."""
    if not values:
        return None
    ordered = sorted(values)
    at = share * (len(ordered) - 1)
    below = int(at)
    above = min(below + 1, len(ordered) - 1)
    return ordered[below] + (at - below) * (ordered[above] - ordered[below])


def mean(values):
    return sum(values) / len(values) if values else None


def median(values):
    return quantile(values, 0.5)


def has_truth(result):
    return bool(result["metrics"]) and "trajectory" in result["metrics"]


def failure(result):
    """Why the run counts as failed, in a few words; None if it does not."""
    if result["code"] != 0:
        return f"exit code {result['code']}: {result['error']}"
    metrics = result["metrics"]
    if metrics is None:
        return "no metrics.json"
    if metrics["tracked"] == 0:
        return "no map"
    if metrics["coverage"] < LEAST_COVERAGE:
        return f"{100 * metrics['coverage']:.0f} % of the frames have a pose"
    if has_truth(result):
        trajectory = metrics["trajectory"]
        if trajectory["status"] != "ok":
            return f"no alignment with the truth: {trajectory['status']}"
        if trajectory["ate_rmse"] > LARGEST_ATE * trajectory["path_length"]:
            return f"ATE {100 * trajectory['ate_rmse'] / trajectory['path_length']:.1f} % of the path"
    return None


def trajectory_value(result, name, live=False):
    """One of the trajectory's errors; None if the run failed or there is no truth."""
    if failure(result) or not has_truth(result):
        return None
    errors = result["metrics"]["trajectory_live" if live else "trajectory"]
    return errors[name] if errors["status"] == "ok" else None


def aligned(result, name):
    """A trajectory of the metrics if it could be compared with the truth, however much of the sequence it covers."""
    errors = result["metrics"].get(name) if result["metrics"] else None
    return errors if errors and errors.get("status", "ok") == "ok" and errors["ate_rmse"] is not None else None


def matches(result):
    """The texts that stand for a true sign."""
    if failure(result) or "text" not in result["metrics"]:
        return []
    return [match for match in result["metrics"]["text"]["matches"] if match["sign"] >= 0]


def angles(results):
    return [match["angle_deg"] for result in results for match in matches(result)]


def centres(results):
    return [match["centre"] for result in results for match in matches(result)]


def signs_visible(result):
    """How many true signs the sequence shows; None if the run does not say."""
    known = result and result["metrics"] and "text" in result["metrics"]
    return result["metrics"]["text"]["signs_visible"] if known else None


def text_count(result, name):
    """How many signs were mapped, or texts are false; 0 for a failed run."""
    return 0 if failure(result) or "text" not in result["metrics"] else result["metrics"]["text"][name]


def histogram(values):
    """How many values lie up to each of ANGLE_BINS, and above the last."""
    counts = [0] * (len(ANGLE_BINS) + 1)
    for value in values:
        counts[next((i for i, end in enumerate(ANGLE_BINS) if value <= end), len(ANGLE_BINS))] += 1
    return counts


def written(value, decimals):
    return "-" if value is None else f"{value:.{decimals}f}"


def millimetres(value, decimals=2):
    return "-" if value is None else written(1000 * value, decimals)
