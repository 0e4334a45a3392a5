"""Copies of the sources in which tests are built with mutants that are switched on at run time, or with one alone."""
import concurrent.futures
import os
import pathlib
import re
import resource
import shutil
import subprocess

from switches import put

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
CXX = shutil.which("clang++") or "g++"
FLAGS = ["-std=c++17", "-w", "-DTEXTPLANE_EXTERN_KERNELS", "-D_GLIBCXX_ASSERTIONS", "-Iinclude", "-Itests", "-isystem", "/usr/include/eigen3"]
if "clang" in CXX:
    FLAGS += ["-ferror-limit=0", "-Wno-invalid-constexpr", "-fsanitize=bounds", "-fsanitize-trap=bounds"]
# Slow tests are compiled with -O1, which takes longer: they run for half a minute without it.
SLOW = ("tests/solver/", "tests/support/", "tests/features/", "tests/geometry/plane_fit", "tests/geometry/triangulate", "tests/landmarks/")
# What defines things that these headers declare.
LINKED = {"textplane/simd/compiler.hpp": "cmake/kernels.cpp", "textplane/simd/targets.hpp": "cmake/kernels.cpp",
          "tests/support/dense.hpp": "tests/support/dense.cpp",
          "textplane/geometry/plane_fit.hpp": "cmake/kernels.cpp"}
NO_CODE = "does not compile"
SWITCH = """extern "C" int textplane_mutant;
#define TEXTPLANE_MUTANT(number) (textplane_mutant == (number))
"""
CHOICE = """#include <cstdlib>
extern "C" { int textplane_mutant; }
__attribute__((constructor(101))) static void choose() {
  const char* number = std::getenv("TEXTPLANE_MUTANT");
  textplane_mutant = number ? std::atoi(number) : -1;
}
"""
PCH = "#include <gtest/gtest.h>\n#include <Eigen/Dense>\n#include \"switch.hpp\"\n"
PLACE = re.compile(r"include/textplane/(\S+?):(\d+)")


class CompileError(Exception):
    """What the compiler said."""


def text_of(header):
    return (ROOT / "include/textplane" / header).read_text()


class Tree:
    """A copy of the sources with {number: (header, text, text instead)} in it, its objects and programs."""

    def __init__(self, path, all_targets, mutants, flags=()):
        self.path, self.mutants, self.lines, self.seconds, self.flags = path, dict(mutants), {}, {}, [*FLAGS, *flags]
        if self.path.exists():
            shutil.rmtree(self.path)
        for folder in ("include", "tests", "cmake"):
            shutil.copytree(ROOT / folder, self.path / folder)
        if not all_targets:
            compiler = self.path / "include/textplane/simd/compiler.hpp"
            text = compiler.read_text()
            assert text.count("#if defined(__x86_64__)\n") == 1
            compiler.write_text(text.replace("#if defined(__x86_64__)\n", "#if 0\n"))
        self.objects = self.path / "objects"
        self.objects.mkdir()
        for name, text in (("switch.hpp", SWITCH), ("choice.cpp", CHOICE)):
            (self.path / name).write_text(text)
        for level in "01":
            (self.path / f"all{level}.hpp").write_text(PCH)
            self.command([CXX, *self.flags, "-O" + level, "-x", "c++-header", f"all{level}.hpp", "-o", f"all{level}.hpp.gch"])
        self.command([CXX, "-O1", "-c", "choice.cpp", "-o", "objects/choice.o"])
        for header in {mutant[0] for mutant in self.mutants.values()}:
            self.put(header)

    def command(self, words):
        try:
            subprocess.run(words, cwd=self.path, check=True, capture_output=True, timeout=1800)
        except subprocess.CalledProcessError as error:
            raise CompileError((error.stdout + error.stderr).decode(errors="replace")) from None

    def put(self, header):
        """Writes a header with its mutants."""
        text, lines = put(text_of(header), [(n, m[1], m[2]) for n, m in self.mutants.items() if m[0] == header])
        (self.path / "include/textplane" / header).write_text(text)
        for number in [n for n, m in self.mutants.items() if m[0] == header]:
            if number in lines:
                self.lines[number] = lines[number]
            else:
                del self.mutants[number]

    def drop(self, said):
        """Takes out the mutants that the compiler named; whether there were any."""
        places = {(header, int(line)) for header, line in PLACE.findall(said)}
        named = [n for n, (header, *_) in self.mutants.items()
                 if any((header, line) in places for line in range(self.lines[n][0], self.lines[n][1] + 1))]
        headers = {self.mutants.pop(n)[0] for n in named}
        for header in headers:
            self.put(header)
        return bool(named)

    def object_of(self, source):
        return self.objects / (source.replace("/", "_") + ".o")

    def compile(self, source):
        """An object of `source`, and what it depends on."""
        kernels, operations = source == "cmake/kernels.cpp", source.startswith("tests/simd/ops/")
        level = "1" if kernels or operations or source.startswith(SLOW) else "0"
        extra = ["-O" + level, "-include", "switch.hpp" if kernels or operations else f"all{level}.hpp"]
        extra += ["-UTEXTPLANE_EXTERN_KERNELS"] if operations else []  # they have kernels of their own
        target = str(self.object_of(source))
        self.command([CXX, *self.flags, *extra, "-MMD", "-MF", target + ".d", "-c", source, "-o", target + ".new"])
        os.replace(target + ".new", target)

    def compile_all(self, sources, jobs):
        """Compiles what has no object yet, without the mutants that do not compile."""
        todo = [source for source in sources if not self.object_of(source).exists()]
        while todo:
            with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
                errors = dict(zip(todo, pool.map(self.trouble, todo)))
            todo = [source for source, said in errors.items() if said]
            dropped = [self.drop(errors[source]) for source in todo]
            if todo and not any(dropped):
                raise RuntimeError(errors[todo[0]][:4000])

    def trouble(self, source):
        try:
            self.compile(source)
            return None
        except CompileError as error:
            return str(error)

    def depends(self, source, header):
        text = pathlib.Path(str(self.object_of(source)) + ".d").read_text().replace("\\\n", " ")
        return bool({header, "include/" + header} & set(text.split())) or header == source

    def sources(self, test):
        """The test's file, and what it is linked with, by the headers that it includes."""
        source = f"tests/{test}.cpp"
        return [source, *sorted({other for header, other in LINKED.items() if self.depends(source, header)})]

    def build(self, tests, jobs=1):
        """Builds the programs of tests, and sees that they pass with every mutant off."""
        self.compile_all([f"tests/{test}.cpp" for test in tests], jobs)
        self.compile_all({source for test in tests for source in self.sources(test)}, jobs)
        for test in tests:
            if test not in self.seconds:
                self.link(test, self.program(test))
                before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
                trouble = self.run(test, -1, 600)
                if trouble:
                    raise RuntimeError(f"without any mutant: {trouble}")
                self.seconds[test] = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before

    def link(self, test, program):
        objects = [str(self.object_of(source)) for source in self.sources(test)]
        self.command([CXX, *self.flags, *objects, "objects/choice.o", "-o", program, "-lgtest_main", "-lgtest", "-lpthread"])

    def program(self, test):
        return "program_" + test.replace("/", "_")

    def run(self, test, number, most=None, program=None):
        """Which test failed with a mutant on, or None. `most`: seconds of CPU time; five times the usual ones at first."""
        most = int(most or 5 * self.seconds[test] + 5)
        try:
            limit = ["sh", "-c", f"ulimit -t {most} -c 0{'' if self.flags[len(FLAGS):] else ' -v 8000000'}; exec \"$@\"", "sh"]
            subprocess.run([*limit, "./" + (program or self.program(test)), "--gtest_brief=1", "--gtest_fail_fast"], cwd=self.path, check=True,
                           capture_output=True, timeout=20 * most,
                           env={**os.environ, "TEXTPLANE_MUTANT": str(number), "ASAN_OPTIONS": "detect_leaks=0"})
            return None
        except subprocess.TimeoutExpired:
            return f"{test}: hangs"
        except subprocess.CalledProcessError as error:
            lines = (error.stdout + error.stderr).decode(errors="replace").splitlines()
            failed = [line.split("]")[1].split(",")[0].strip() for line in lines if "[  FAILED  ]" in line and "." in line]
            return f"{test}: {failed[0] if failed else 'ends with ' + str(error.returncode)}"


class Alone:
    """A copy of the sources with one mutant at a time in it, for those that cannot be switched.

    Most of those are sizes of arrays, so AddressSanitizer looks on."""

    def __init__(self, path, all_targets):
        self.tree = Tree(path, all_targets, {}, ["-fsanitize=address"])

    def run(self, test, mutant):
        """Which test failed, or None; what the header is part of is compiled anew."""
        header, old, new = mutant[:3]
        tree, path = self.tree, self.tree.path / "include/textplane" / header
        tree.build([test])
        whole = path.read_text()
        stale = [source for source in tree.sources(test) if tree.depends(source, "textplane/" + header)]
        kept = {source: pathlib.Path(str(tree.object_of(source)) + ".whole") for source in stale}
        try:
            for source, other in kept.items():
                os.replace(tree.object_of(source), other)
            path.write_text(whole.replace(old, new))
            for source in stale:
                if tree.trouble(source):
                    return NO_CODE
            tree.link(test, "program_alone")
            return tree.run(test, -1, program="program_alone")
        finally:
            path.write_text(whole)
            for source, other in kept.items():
                os.replace(other, tree.object_of(source))
