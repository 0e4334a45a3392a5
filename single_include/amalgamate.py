#!/usr/bin/env python3
"""Writes single_include/textplane.hpp: all of include/textplane but the adapters, in one file.

    amalgamate.py                 writes the file beside this script
    amalgamate.py --output FILE   writes it elsewhere
    amalgamate.py --check         exit code 1 and one line where the file beside this script is out of date

A header with an include guard is put where it is first included, once. The *.inl files have no guard: each inclusion is expanded
where it stands, so that a kernel's body is there once for every target, as the preprocessor would see it. The names of kernels and
of the targets' operations are macros there and are looked up here. Comments of bodies are kept in their first expansion alone.

The file names the version and a hash of what it was made of: a committed file cannot name its own commit, and this tells more.
"""
import argparse
import hashlib
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
INCLUDE = ROOT / "include"
UMBRELLA = "textplane/textplane.hpp"

INCLUDE_LINE = re.compile(r'\s*#\s*include\s+(?:"(?P<name>textplane/[^"]+)"|<(?P<angled>textplane/[^>]+)>|(?P<macro>TEXTPLANE_SIMD_(?:KERNEL|OPS))\s*$)')
KERNEL = re.compile(r'\s*#\s*define\s+TEXTPLANE_SIMD_KERNEL\s+"([^"]+)"')
SLOT = re.compile(r"\s*#\s*define\s+TEXTPLANE_SIMD_SLOT\s+(\d+)")
SLOT_NAME = re.compile(r"^\s*#\s*define\s+TEXTPLANE_SIMD_NAME_(\d+)\s+(\w+)", re.M)
TARGETS = "textplane/simd/targets.hpp"
REGION = "textplane/simd/region.inl"
CONDITION = re.compile(r"\s*#\s*(?P<word>ifdef|ifndef|if|elif|else|endif)\b")


class Failure(Exception):
    pass


class Amalgamation:
    def __init__(self):
        self.lines = []
        self.sources = {}      # name -> text, in the order of first use
        self.open = []         # the files being expanded
        self.done = set()      # guarded headers that are already there
        self.expanded = set()  # bodies whose comments are already there
        self.kernel = None
        self.target = None     # the name of the target whose region is being expanded

    def read(self, name, where):
        if name not in self.sources:
            path = INCLUDE / name
            if not path.is_file():
                raise Failure(f"{where}: includes {name}, which does not exist")
            self.sources[name] = path.read_text(encoding="utf-8")
        return self.sources[name]

    def emit(self, line, comments):
        if not comments:
            if line.lstrip().startswith("//") or not line.strip():
                return
            line = re.sub(r"\s+//[^\"]*$", "", line)
        if line.strip() or (self.lines and self.lines[-1].strip()):
            self.lines.append(line)

    def include(self, name, where, depth):
        if name.endswith(".inl"):
            if name != REGION or self.target != "none":
                self.expand(name, where)
            return
        # Under a condition the one copy would be missing wherever the condition is false.
        if depth > 1:
            raise Failure(f"{where}: includes {name} under a condition")
        if name in self.done:
            return
        self.done.add(name)
        self.expand(name, where)

    def expand(self, name, where):
        text = self.read(name, where)
        if name in self.open:
            raise Failure(f"{where}: {name} includes itself")
        body = name.endswith(".inl")
        comments = name not in self.expanded
        self.expanded.add(name)
        if not body:
            guard = re.search(r"^#ifndef (TEXTPLANE_\w+_HPP)\n#define \1$", text, re.M)
            if not guard:
                raise Failure(f"include/{name}: has no include guard")
        self.open.append(name)
        depth = 0  # of open conditions
        for number, line in enumerate(text.splitlines(), 1):
            where = f"include/{name}:{number}"
            condition = CONDITION.match(line)
            if condition:
                depth += {"if": 1, "ifdef": 1, "ifndef": 1, "endif": -1}.get(condition["word"], 0)
                if depth < 0:
                    raise Failure(f"{where}: #{condition['word']} without #if")
            found = INCLUDE_LINE.match(line)
            if found:
                operations = f"textplane/simd/ops/{self.target}.inl"
                target = found["name"] or found["angled"] or (self.kernel if found["macro"].endswith("KERNEL") else operations)
                if target is None:
                    raise Failure(f"{where}: includes a kernel that nobody named")
                self.include(target, where, depth)
                continue
            kernel, slot = KERNEL.match(line), SLOT.match(line)
            if kernel:
                self.kernel = kernel[1]
            if slot:
                self.target = dict(SLOT_NAME.findall(self.read(TARGETS, where)))[slot[1]]
                if self.target == "none":
                    continue
            self.emit(line, comments)
        if depth:
            raise Failure(f"include/{name}: a condition is not closed")
        self.open.pop()


def version(config):
    numbers = [re.search(rf"#define TEXTPLANE_VERSION_{part} (\d+)", config) for part in ("MAJOR", "MINOR", "PATCH")]
    if not all(numbers):
        raise Failure("include/textplane/config.hpp: names no version")
    return ".".join(n[1] for n in numbers)


def build():
    a = Amalgamation()
    a.done.add(UMBRELLA)
    a.expand(UMBRELLA, "amalgamate.py")
    digest = hashlib.sha256()
    for name in sorted(a.sources):
        digest.update(f"{name}\n{a.sources[name]}\n".encode())
    licence = "\n".join(("// " + line).rstrip() for line in (ROOT / "LICENSE").read_text(encoding="utf-8").splitlines())
    number, short = version(a.sources["textplane/config.hpp"]), digest.hexdigest()[:16]
    head = f"""\
// textplane {number} in one header, made of {len(a.sources)} files by single_include/amalgamate.py. Do not edit.
// Hash of these files: {short}
//
// It needs Eigen 3.3 and C++17, and no compile flag: kernels for every instruction set are in it and chosen at run time.
//
{licence}

#ifndef TEXTPLANE_SINGLE_HEADER
#define TEXTPLANE_SINGLE_HEADER "{number} {short}"
#endif
"""
    return head + "\n" + "\n".join(a.lines).strip() + "\n"


def main():
    parser = argparse.ArgumentParser(description="Writes single_include/textplane.hpp.")
    parser.add_argument("--check", action="store_true", help="compare with the committed file, write nothing")
    parser.add_argument("--output", type=pathlib.Path, default=pathlib.Path(__file__).resolve().parent / "textplane.hpp")
    arguments = parser.parse_args()
    try:
        text = build()
        if not arguments.check:
            arguments.output.write_text(text, encoding="utf-8")
        elif not arguments.output.is_file() or arguments.output.read_text(encoding="utf-8") != text:
            print(f"{arguments.output}: out of date; run single_include/amalgamate.py and commit", file=sys.stderr)
            return 1
    except (Failure, OSError) as error:
        print(f"amalgamate.py: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
