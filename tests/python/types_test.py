"""Documentation of every public name, and mypy --strict on the package and the examples."""
import inspect
import os
import pathlib
import re
import subprocess
import sys

import pytest

import textplane as tp

MODULES = [tp]
try:
    import textplane.slam
    import textplane.stage

    MODULES += [textplane.slam, textplane.stage]
except ImportError:
    pass
FOLDER = pathlib.Path(os.environ.get("TEXTPLANE_PYTHON", pathlib.Path(__file__).parents[2] / "bindings/python"))


def public_names():
    for module in MODULES:
        for name in getattr(module, "__all__", dir(module)):
            item = getattr(module, name)
            if name.startswith("_") or inspect.ismodule(item):
                continue
            yield f"{module.__name__}.{name}", item
            if inspect.isclass(item) and not hasattr(item, "__members__"):
                for member, value in vars(item).items():
                    if not member.startswith("_"):
                        yield f"{module.__name__}.{name}.{member}", value


def test_every_public_name_is_documented():
    names = list(public_names())
    assert len(names) > 150
    assert not [name for name, item in names if len((item.__doc__ or "").strip()) < 10]


def test_functions_say_shapes_or_types():
    for name, item in public_names():
        if callable(item) and not inspect.isclass(item) and not isinstance(item, staticmethod):
            assert re.match(r"\w+\(.*\) -> .+\n\n", item.__doc__), name


def test_mypy_is_content_with_package_and_examples():
    pytest.importorskip("mypy")
    programs = [str(program) for program in sorted((FOLDER / "examples").glob("*.py"))] if len(MODULES) > 1 else []
    package = pathlib.Path(tp.__file__).parent
    environment = dict(os.environ, MYPYPATH=os.pathsep.join([str(package.parent), str(FOLDER / "examples")]))
    for files in [str(package / "__init__.py"), str(package / "_core.pyi")], programs:
        if not files:
            continue
        # matplotlib, of the tour, may come without types.
        result = subprocess.run([sys.executable, "-m", "mypy", "--strict", "--cache-dir", os.devnull,
                                 "--ignore-missing-imports", "--scripts-are-modules", *files],
                                capture_output=True, text=True, env=environment)
        assert result.returncode == 0, result.stdout + result.stderr
