#!/usr/bin/env python3
"""Writes the type stubs of a module of the package from its docstrings.

usage: make_stubs.py MODULE OUTPUT.pyi

The first line of a function's docstring is its signature, and a property's docstring is "type: what it is". So the stubs
say what the program says, and a public name without a docstring ends this with an error.
"""
import enum
import importlib
import pathlib
import re
import sys

HEAD = '''"""{doc}"""
from typing import Any, Callable, ClassVar, Iterator, Sequence

from {core} import {names}
from .typing import Array, Numbers, Pose

'''
CORE = "Camera, Pyramid, SE3, Status, TextPatch"


class Undocumented(Exception):
    pass


def quoted(text, indent):
    text = text.replace("\\", "\\\\").replace('"""', "'''").strip()
    return f'{indent}"""{text}"""\n'


def signature(name, doc, indent, first=""):
    """The stub of a function, from "name(arguments) -> type", a blank line, and what it does."""
    match = re.match(rf"{re.escape(name)}\((.*)\) -> ([^\n]+)\n\n(.+)", doc or "", flags=re.S)
    if not match:
        raise Undocumented(f"{name}: the docstring does not begin with a signature and a blank line: {doc!r}")
    arguments = ", ".join(part for part in (first, match[1]) if part)
    return f"{indent}def {name}({arguments}) -> {match[2]}:\n{quoted(match[3], indent + '    ')}"


def property_stub(name, value, indent):
    match = re.match(r"([^:\n]+): (.+)", value.__doc__ or "", flags=re.S)
    if not match:
        raise Undocumented(f"{name}: the docstring is not \"type: what it is\": {value.__doc__!r}")
    out = f"{indent}@property\n{indent}def {name}(self) -> {match[1]}:\n{quoted(match[2], indent + '    ')}"
    if value.fset:
        out += f"{indent}@{name}.setter\n{indent}def {name}(self, value: {match[1]}) -> None: ...\n"
    return out


def enum_stub(name, cls):
    out = f"class {name}:\n" + quoted(cls.__doc__.split("\n\nMembers:")[0], "    ")
    out += "".join(f"    {member}: ClassVar[{name}]\n" for member in cls.__members__)
    out += f"    __members__: ClassVar[dict[str, {name}]]\n    def __init__(self, value: int) -> None: ...\n"
    out += "    def __int__(self) -> int: ...\n    @property\n    def name(self) -> str: ...\n"
    return out + "    @property\n    def value(self) -> int: ...\n"


def class_stub(name, cls):
    if hasattr(cls, "__members__") or issubclass(cls, enum.Enum):
        return enum_stub(name, cls)
    if not cls.__doc__:
        raise Undocumented(f"{name}: no docstring")
    base = "(RuntimeError)" if issubclass(cls, RuntimeError) else ""
    out = f"class {name}{base}:\n" + quoted(cls.__doc__, "    ")
    if base:
        return out + "    status: Status\n    result: Any\n"
    for member, value in vars(cls).items():
        public = not member.startswith("_") or (callable(value) and member in (
            "__init__", "__matmul__", "__repr__", "__len__", "__getitem__"))
        if not public:
            continue
        if isinstance(value, property):
            out += property_stub(member, value, "    ")
        elif isinstance(value, staticmethod):
            out += "    @staticmethod\n" + signature(member, value.__func__.__doc__, "    ")
        elif member == "__init__" and "(self" in (value.__doc__ or "(self"):
            continue  # pybind11's own, of a class that only functions make
        elif callable(value):
            out += signature(member, value.__doc__, "    ", "self")
    return out


def stubs(module):
    core = module.__name__.endswith("._core")
    out = HEAD.format(doc=module.__doc__, core="._core" if not core else ".typing", names=CORE if not core else "Array")
    out += "__version__: str\n" if core else ""
    for name, value in vars(module).items():
        if name.startswith("_"):
            continue
        if isinstance(value, type):
            out += "\n" + class_stub(name, value)
        elif callable(value):
            out += "\n" + signature(name, value.__doc__, "")
        else:
            raise Undocumented(f"{name}: neither a class nor a function")
    return out


def main():
    if len(sys.argv) != 3:
        print(__doc__, file=sys.stderr)
        return 2
    sys.path.pop(0)  # this folder, which has the package without its modules
    try:
        text = stubs(importlib.import_module(sys.argv[1]))
    except Undocumented as error:
        print(f"{sys.argv[1]}: {error}", file=sys.stderr)
        return 1
    pathlib.Path(sys.argv[2]).write_text(text)
    return 0


if __name__ == "__main__":
    sys.exit(main())
