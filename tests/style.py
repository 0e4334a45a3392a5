#!/usr/bin/env python3
"""Checks the limits that CONTRIBUTING.md sets, and names all offenders.

usage: style.py [ROOT] [--clang-format PROGRAM] [--only CHECK[,CHECK...]]

Checks: format (clang-format), columns, file (lines), folder (units: a header and its source are one), function (lines). Looks
at the files that git tracks. Exit code 77 where clang-format is missing and nothing else was asked for.
"""
import argparse
import ast
import collections
import pathlib
import re
import shutil
import subprocess
import sys

COLUMNS, FILE_LINES, FUNCTION_LINES, FOLDER_UNITS = 120, 300, 60, 25
SKIPPED = 77
CPP = {".hpp", ".cpp", ".inl"}
CODE = CPP | {".py", ".sh", ".cmake", ".js", ".css", ".html", ".txt", ""}
GENERATED = {"single_include/textplane.hpp"}
NO_CODE = {"LICENSE"}
CONTAINER = re.compile(r"\b(namespace|class|struct|union|enum|extern)\b")
FORMATTER = "clang-format", "clang-format-14"


def tracked(root):
    listing = subprocess.run(["git", "-C", str(root), "ls-files", "-z"], capture_output=True, text=True)
    if listing.returncode != 0:
        files = [path.relative_to(root) for path in sorted(root.rglob("*")) if path.is_file()]
        return [path for path in files if path.parts[0] not in (".git", "build", "out", "models")]
    return [pathlib.Path(name) for name in listing.stdout.split("\0") if name and (root / name).is_file()]


def without_comments(text):
    """The C++ text, line by line, without comments, literals and preprocessor lines, and with one branch of each #if."""
    literal = r'R"(\w*)\((?:.|\n)*?\)\1"|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])*\''
    text = re.sub(rf"//[^\n]*|/\*(?:.|\n)*?\*/|{literal}", lambda m: "\n" * m[0].count("\n"), text)
    out, skipped, continued = [], [], False
    for line in text.split("\n"):
        directive = re.match(r"\s*#\s*(\w+)", line)
        word = directive[1] if directive else ""
        if word in ("if", "ifdef", "ifndef"):
            skipped.append(False)
        elif word in ("else", "elif") and skipped:
            skipped[-1] = True
        elif word == "endif" and skipped:
            skipped.pop()
        out.append("" if directive or continued or any(skipped) else line)
        continued = bool(directive or continued) and line.endswith("\\")
    return "\n".join(out)


def cpp_functions(text):
    """(first line, lines) of each function: a brace after parentheses, where only namespaces and classes are open."""
    depth, inside, statement, line, first, parentheses = [], None, "", 1, None, 0
    for character in without_comments(text):
        if character == "\n":
            line += 1
        if inside is None and not statement.strip():
            statement, first = "", line
        if character in "()" and inside is None:
            parentheses += 1 if character == "(" else -1
        if character == "{":
            is_function = inside is None and parentheses == 0 and "(" in statement and not CONTAINER.search(
                re.sub(r"<[^<>]*>|\([^()]*\)", "", statement))
            if is_function:
                inside, start = len(depth), first
            depth.append(character)
            statement = "" if inside is None else statement
        elif character == "}" and depth:
            depth.pop()
            if inside == len(depth):
                inside = None
                yield start, line - start + 1
            statement = "" if inside is None else statement
        elif character == ";" and inside is None and parentheses == 0:
            statement = ""
        elif inside is None:
            statement += character


def python_functions(text):
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef)):
            yield node.lineno, node.end_lineno - node.lineno + 1


def is_python(path, text):
    return path.suffix == ".py" or (path.suffix == "" and text.startswith("#!/usr/bin/env python3"))


class Style:
    def __init__(self, root, formatter):
        self.root, self.formatter = root, formatter
        self.files = [path for path in tracked(root) if path.as_posix() not in GENERATED]
        self.code = {path: (root / path).read_text(errors="replace") for path in self.files
                     if path.suffix in CODE and path.name not in NO_CODE and not path.name.startswith(".")}
        self.cpp = [path for path in self.code if path.suffix in CPP]

    def format(self):
        if not self.formatter:
            print("clang-format is not installed: the format is not checked")
            return
        result = subprocess.run([self.formatter, "--dry-run", *map(str, self.cpp)], cwd=self.root, capture_output=True,
                                text=True)
        places = re.findall(r"^(\S+?):(\d+):\d+: \w+: code should be clang-formatted", result.stderr, flags=re.M)
        for name, count in collections.Counter(name for name, _ in places).items():
            yield f"{name}: {count} places to format: clang-format -i {name}"
        if result.returncode != 0:
            yield f"{self.formatter} ended with {result.returncode}: {result.stderr}"

    def columns(self):
        for path in self.cpp:
            for number, line in enumerate(self.code[path].splitlines(), 1):
                if len(line) > COLUMNS:
                    yield f"{path}:{number}: {len(line)} columns"

    def file(self):
        for path, text in self.code.items():
            lines = text.count("\n")
            if lines > FILE_LINES:
                yield f"{path}: {lines} lines"

    def folder(self):
        units = collections.defaultdict(set)
        for path in self.files:
            if path.suffix in CODE - {".txt"}:
                units[path.parent].add(path.stem)
        for folder, names in units.items():
            if len(names) > FOLDER_UNITS:
                yield f"{folder}: {len(names)} units"

    def function(self):
        for path, text in self.code.items():
            functions = cpp_functions if path.suffix in CPP else python_functions if is_python(path, text) else None
            for line, lines in functions(text) if functions else ():
                if lines > FUNCTION_LINES:
                    yield f"{path}:{line}: a function of {lines} lines"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("root", nargs="?", type=pathlib.Path, default=pathlib.Path(__file__).resolve().parent.parent)
    parser.add_argument("--clang-format", default=next(filter(None, map(shutil.which, FORMATTER)), None))
    parser.add_argument("--only", default="format,columns,file,folder,function")
    arguments = parser.parse_args()
    if arguments.only == "format" and not arguments.clang_format:
        print("skipped: there is no clang-format; Debian's package of that name has it")
        sys.exit(SKIPPED)
    style = Style(arguments.root.resolve(), arguments.clang_format)
    offences = [(name, offence) for name in arguments.only.split(",") for offence in getattr(style, name)()]
    for _, offence in offences:
        print(offence)
    counts = collections.Counter(name for name, _ in offences)
    print(f"{len(style.files)} files; " + ", ".join(f"{name}: {counts[name]}" for name in arguments.only.split(",")))
    sys.exit(1 if offences else 0)


if __name__ == "__main__":
    main()
