"""viewers_test.py ROOT TEXTSLAM SEQUENCE: the program of docs/viewers.md runs as it stands. It gets a stand-in for the
package rerun, and what it logs is checked."""
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

STAND_IN = '''
import atexit

counts, points, labels = {}, 0, set()
def init(name, spawn): assert spawn
def set_time(timeline, sequence): assert timeline == "frame" and sequence >= 0
def Quaternion(xyzw):
    assert abs(sum(q * q for q in xyzw) - 1) < 1e-3
def Transform3D(translation, rotation):
    assert len(translation) == 3
    return "camera"
def Points3D(positions):
    assert all(len(p) == 3 for p in positions)
    return "points", len(positions)
def LineStrips3D(strips, labels):
    assert all(len(strip) == 5 and all(len(p) == 3 for p in strip) for strip in strips) and len(labels) == len(strips)
    return "text", labels[0]
def Clear(recursive): return "clear", recursive
def log(path, what):
    counts[path.split("/")[0]] = counts.get(path.split("/")[0], 0) + 1
    global points
    if what[0] == "points": points = what[1]
    if what[0] == "text": labels.add(what[1])
@atexit.register
def tell(): print("logged", counts.get("camera", 0), "poses", points, "points", len(labels), "texts")
'''


def main(root, textslam, sequence):
    page = (Path(root) / "docs/viewers.md").read_text(encoding="utf-8")
    program = re.search(r"```python\n(.*?)```", page, re.DOTALL).group(1)
    with tempfile.TemporaryDirectory() as folder:
        home = Path(folder)
        (home / "live.py").write_text(program, encoding="utf-8")
        (home / "rerun.py").write_text(STAND_IN, encoding="utf-8")
        environment = dict(os.environ, PATH=f"{Path(textslam).resolve().parent}{os.pathsep}{os.environ['PATH']}")
        run = subprocess.run([sys.executable, "live.py", sequence, "--output", "out", "--no-report"], cwd=home, env=environment,
                             capture_output=True, text=True)
        if run.returncode != 0:
            sys.exit(f"live.py ended with {run.returncode}:\n{run.stdout}{run.stderr}")
        told = re.search(r"logged (\d+) poses (\d+) points (\d+) texts", run.stdout)
        if not told:
            sys.exit(f"nothing was logged:\n{run.stdout}{run.stderr}")
        poses, points, texts = map(int, told.groups())
        if poses < 40 or points < 100 or texts < 2:
            sys.exit(f"too little was logged: {told.group(0)}")


if __name__ == "__main__":
    main(*sys.argv[1:])
