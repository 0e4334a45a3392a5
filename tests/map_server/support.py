"""What the checks of maps on a server share: a server, the programs, and what a map file holds."""
import pathlib
import re
import shutil
import sqlite3
import subprocess

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
VIRTUAL = "words", "text_boxes"


class Server:
    """A private one, and psql to it as its owner or as another role."""

    def __init__(self, folder):
        self.folder = folder
        said = subprocess.run([ROOT / "scripts/map-server", "start", folder], check=True, capture_output=True, text=True)
        self.database = said.stdout.strip().splitlines()[-1]
        programs = sorted(pathlib.Path("/usr/lib/postgresql").glob("*/bin/psql"))
        self.psql = shutil.which("psql") or str(programs[-1])

    def sql(self, text, database="textslam"):
        result = subprocess.run([self.psql, "-h", self.folder, "-U", "textslam", "-d", database, "-XqtA", "-v", "ON_ERROR_STOP=1"],
                                input=text, capture_output=True, text=True)
        assert result.returncode == 0, result.stderr
        return result.stdout.strip()

    def named(self, database):
        return self.database.replace("dbname=textslam", "dbname=" + database)

    def remove(self):
        subprocess.run([ROOT / "scripts/map-server", "remove", self.folder], check=True)


class Checks:
    def __init__(self, build, work, server):
        self.program, self.slam = build / "bin/textslam-map", build / "bin/textslam"
        self.work, self.server, self.count = work, server, 0
        self.maps = [self.mapped(walk) for walk in (0, 1)]

    def mapped(self, walk):
        file = self.work / f"walk{walk}.db"
        self.slam_run("--render", "room", "--frames", "80", "--walk", walk, "--output", self.work / f"out{walk}", "--save-map", file)
        return file

    def slam_run(self, *words):
        subprocess.run([self.slam, *map(str, words), "--no-report"], check=True, capture_output=True)

    def run(self, *words, code=0):
        """The output of textslam-map; what it refuses is one line."""
        result = subprocess.run([self.program, *map(str, words)], capture_output=True, text=True)
        assert result.returncode == code, f"{words}: {result.returncode}, {result.stdout}{result.stderr}"
        if code:
            assert result.stdout == "" and result.stderr.count("\n") == 1, result.stderr
        return result.stdout + result.stderr

    def refused(self, part, *words):
        said = self.run(*words, code=2)
        assert said.startswith("textslam-map: ") and part in said, f"{said} should say '{part}'"

    def copy(self, walk, name):
        file = self.work / name
        shutil.copy(self.maps[walk], file)
        return file

    def push(self, file, *more):
        return self.run("push", file, self.server.database, *more)

    def pull(self, file, *more):
        return self.run("pull", self.server.database, file, *more)

    def change(self, file):
        """A save that changes nothing else."""
        with sqlite3.connect(file) as connection:
            connection.execute("update map set revision = revision + 1")

    def comes_from(self, file, name):
        """The file says that it comes from what the server has of this name."""
        identity = self.server.sql(f"select id, revision from textslam.maps where name = '{name}'").split("|")
        with sqlite3.connect(file) as connection:
            connection.execute("insert or replace into origins values (?, ?, 0)", identity)

    def check(self, name):
        getattr(self, name)()
        self.count += 1
        print(f"ok: {name.replace('_', ' ')}", flush=True)


def tables_of(file):
    """All that a map file holds, without what it remembers of servers."""
    connection = sqlite3.connect(file)
    names = [row[0] for row in connection.execute("select name from sqlite_master where type = 'table'")]
    names = [name for name in names if name in VIRTUAL or not re.match("words_|text_boxes_|origins|sqlite_", name)]
    return {name: sorted(map(repr, connection.execute(f"select * from {name}"))) for name in names}


def content_of(file):
    """The same without the count of saves."""
    return {name: rows for name, rows in tables_of(file).items() if name != "map"}


def sessions_of(file):
    return {row[0] for row in sqlite3.connect(file).execute("select sequence from sessions")}
