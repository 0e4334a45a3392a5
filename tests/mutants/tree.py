"""Copies of the sources in which the tests of one mutant after another are built and run."""
import pathlib
import shutil
import subprocess

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
FLAGS = ["-std=c++17", "-w", "-DTEXTPLANE_EXTERN_KERNELS", "-D_GLIBCXX_ASSERTIONS", "-Iinclude", "-Itests", "-isystem", "/usr/include/eigen3"]
TIMEOUT = 300
NO_CODE = "does not compile"


class Tree:
    """A copy of the sources, objects of the whole code, and programs of the broken one."""

    def __init__(self, path, all_targets):
        self.path = path
        self.passed = set()
        if self.path.exists():
            shutil.rmtree(self.path)
        for folder in ("include", "tests", "cmake"):
            shutil.copytree(ROOT / folder, self.path / folder)
        if not all_targets:
            targets = self.path / "include/textplane/simd/targets.hpp"
            text = targets.read_text()
            assert text.count("#if defined(__x86_64__)\n") == 1
            targets.write_text(text.replace("#if defined(__x86_64__)\n", "#if 0\n"))
        (self.path / "all.hpp").write_text("#include <gtest/gtest.h>\n#include <Eigen/Core>\n#include <Eigen/Geometry>\n")
        self.objects = self.path / "objects"
        self.objects.mkdir()
        self.command(["g++", *FLAGS, "-O0", "-x", "c++-header", "all.hpp"])

    def command(self, words):
        return subprocess.run(words, cwd=self.path, check=True, capture_output=True, timeout=900)

    def compile(self, source, name):
        """An object of `source`, and what it depends on."""
        kernels = source == "cmake/kernels.cpp"
        extra = ["-O1"] if kernels or source.endswith("dense.cpp") else ["-O0", "-include", "all.hpp"]
        target = self.objects / (name + ".o")
        self.command(["g++", *FLAGS, *extra, "-MMD", "-MF", str(target) + ".d", "-c", source, "-o", str(target)])
        return target

    def whole(self, source):
        """The object of the unbroken source; compiled when first asked for."""
        name = source.replace("/", "_")
        target = self.objects / (name + ".o")
        return target if target.exists() else self.compile(source, name)

    def depends(self, source, header):
        text = pathlib.Path(str(self.whole(source)) + ".d").read_text().replace("\\\n", " ")
        return bool({header, "include/" + header} & set(text.split())) or header == source

    def sources(self, test):
        """The test's file, and what it is linked with: kernels and dense matrices only where it includes their headers."""
        source = f"tests/{test}.cpp"
        linked = {"textplane/simd/targets.hpp": "cmake/kernels.cpp", "tests/support/dense.hpp": "tests/support/dense.cpp"}
        return [source, *(other for header, other in linked.items() if self.depends(source, header))]

    def run(self, test, header=None, broken=None):
        """Which test failed, or None; objects that `header` is part of are compiled anew, once for one dict `broken`."""
        broken = {} if broken is None else broken
        sources = self.sources(test)
        objects = []
        try:
            for source in sources:
                if not header or not self.depends(source, header):
                    objects.append(self.whole(source))
                    continue
                if source not in broken:
                    try:
                        broken[source] = self.compile(source, "broken_" + source.replace("/", "_"))
                    except subprocess.CalledProcessError:
                        return NO_CODE
                objects.append(broken[source])
            self.command(["g++", *map(str, objects), "-o", "program", "-lgtest_main", "-lgtest", "-lpthread"])
            subprocess.run(["./program", "--gtest_brief=1", "--gtest_fail_fast"], cwd=self.path, check=True, capture_output=True,
                           timeout=TIMEOUT)
            return None
        except subprocess.TimeoutExpired:
            return f"{test}: hangs"
        except subprocess.CalledProcessError as error:
            lines = (error.stdout + error.stderr).decode(errors="replace").splitlines()
            failed = [line.split("]")[1].split(",")[0].strip() for line in lines if "[  FAILED  ]" in line and "." in line]
            return f"{test}: {failed[0] if failed else 'ends with ' + str(error.returncode)}"
