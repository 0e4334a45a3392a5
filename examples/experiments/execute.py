"""Runs cases and keeps their results: OUTPUT/runs/<case>/<mode>/result.json beside the files of textslam.

A result counts as long as its program and arguments stay the same. An interrupted run has none and runs again. A failed
run is a result too.
"""
import concurrent.futures
import hashlib
import json
import os
import shutil
import signal
import subprocess
import threading
import time
from pathlib import Path

from plan import MODES

INTERRUPTED = (-signal.SIGINT, -signal.SIGTERM)
_print_lock = threading.Lock()


def say(text):
    with _print_lock:
        print(text, flush=True)


def fingerprint(program):
    return hashlib.sha256(Path(program).read_bytes()).hexdigest()[:16]


def call(command):
    """Exit code, the last line of standard error, wall and CPU seconds of the command. Raises KeyboardInterrupt if it
    was interrupted."""
    start = time.monotonic()
    process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    errors = process.stderr.read().decode("utf-8", "replace").strip().splitlines()
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode in INTERRUPTED:
        raise KeyboardInterrupt  # stopped from outside: not a result
    return {
        "code": process.returncode,
        "error": errors[-1] if errors else "",
        "wall_s": time.monotonic() - start,
        "cpu_s": usage.ru_utime + usage.ru_stime,
    }


def load(path):
    try:
        return json.loads(Path(path).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return None


class Runner:
    def __init__(self, textslam, output, retry_failed=False, keep_frames=False):
        self.textslam, self.output = str(textslam), Path(output)
        self.program = fingerprint(textslam)
        self.retry_failed, self.keep_frames = retry_failed, keep_frames

    def folder(self, case, mode):
        return self.output / "runs" / case.name / mode

    def key(self, case, mode):
        source = [str(Path(case.sequence).resolve())] if case.sequence else case.rendering
        return {"program": self.program, "arguments": source + case.arguments + ["--mode", mode]}

    def result(self, case, mode):
        """The result of the run, or None if there is none of this program and these arguments."""
        result = load(self.folder(case, mode) / "result.json")
        return result if result and result.get("key") == self.key(case, mode) else None

    def is_finished(self, case, mode):
        result = self.result(case, mode)
        return result is not None and (result["code"] == 0 or not self.retry_failed)

    def run_cases(self, cases):
        """Runs the unfinished modes of cases with one rendering, or of a case of a real sequence. Deletes the frames
        afterwards unless they are to be kept."""
        missing = [(case, mode) for case in cases for mode in MODES if not self.is_finished(case, mode)]
        if not missing:
            return
        first = cases[0]
        scratch = self.output / "frames" / first.name
        try:
            rendering = None if first.sequence else self.render(first, scratch)
            for case, mode in missing:
                self.run_mode(case, mode, case.sequence or scratch / "sequence", rendering)
        finally:
            if not self.keep_frames:
                shutil.rmtree(scratch, ignore_errors=True)

    def render(self, case, folder):
        """What call() returns for the rendering; None if kept frames serve."""
        arguments, note = " ".join(case.rendering), folder / "rendered.txt"
        if self.keep_frames and note.exists() and note.read_text(encoding="utf-8") == arguments:
            return None
        shutil.rmtree(folder, ignore_errors=True)
        rendering = call([self.textslam, *case.rendering, "--render-only", "--output", str(folder)])
        if rendering["code"] == 0:
            note.write_text(arguments, encoding="utf-8")
        return rendering

    def run_mode(self, case, mode, sequence, rendering):
        folder = self.folder(case, mode)
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        if rendering and rendering["code"] != 0:
            run = rendering
        else:
            run = call([self.textslam, str(sequence), *case.arguments, "--mode", mode, "--output", str(folder)])
        result = {"key": self.key(case, mode), **run}
        result["metrics"] = load(folder / "metrics.json")
        result["tracking_s"] = seconds_of(load(folder / "timing.json"))
        part = folder / "result.json.part"
        part.write_text(json.dumps(result, indent=1) + "\n", encoding="utf-8")
        part.rename(folder / "result.json")
        outcome = "done" if run["code"] == 0 else f"failed ({run['code']}): {run['error']}"
        say(f"{case.name} {mode}: {outcome}, {run['wall_s']:.1f} s")

    def run_all(self, cases, jobs):
        """All cases, `jobs` at a time of those that do not share a rendering."""
        together = {}
        for case in cases:
            together.setdefault(case.name if case.sequence else tuple(case.rendering), []).append(case)
        with concurrent.futures.ThreadPoolExecutor(max_workers=jobs) as pool:
            futures = [pool.submit(self.run_cases, group) for group in together.values()]
            try:
                for future in concurrent.futures.as_completed(futures):
                    future.result()
            except BaseException:
                pool.shutdown(wait=False, cancel_futures=True)
                raise


def seconds_of(timing):
    """Seconds of tracking and mapping of all frames; None without timings."""
    if not timing:
        return None
    return sum(frame["tracking"] + frame["mapping"] for frame in timing["frames"]) / 1000
