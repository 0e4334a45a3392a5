"""Builds the package by CMake, with the CMakeLists.txt of the repository: docs/python.md."""
import os
import pathlib
import re
import subprocess
import sys

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent


class CMakeBuild(build_ext):
    def run(self):
        build = pathlib.Path(self.build_temp).resolve()
        options = ["-DCMAKE_BUILD_TYPE=Release", "-DCMAKE_CXX_FLAGS_RELEASE=-O2 -DNDEBUG", "-DTEXTPLANE_BUILD_PYTHON=ON",
                   "-DTEXTPLANE_BUILD_TESTS=OFF", "-DTEXTPLANE_BUILD_EXAMPLES=AUTO", "-DTEXTPLANE_UNITY_BUILD=ON",
                   "-DTEXTPLANE_INSTALL=OFF", f"-DPython_EXECUTABLE={sys.executable}"]
        options += os.environ.get("CMAKE_ARGS", "").split()
        jobs = str(os.cpu_count() or 2)
        subprocess.run(["cmake", "-S", str(ROOT), "-B", str(build), *options], check=True)
        subprocess.run(["cmake", "--build", str(build), "--target", "textplane_python", "--parallel", jobs], check=True)
        to = HERE if self.inplace else pathlib.Path(self.build_lib).resolve()
        (to / "textplane").mkdir(parents=True, exist_ok=True)
        for file in sorted((build / "python" / "textplane").iterdir()):
            if file.suffix in (".so", ".pyd", ".pyi"):
                command = ["strip", "--strip-unneeded"] if file.suffix == ".so" else None
                target = to / "textplane" / file.name
                self.copy_file(str(file), str(target))
                if command:
                    subprocess.run([*command, str(target)], check=False)


def version():
    text = (ROOT / "include" / "textplane" / "config.hpp").read_text()
    return re.search(r'TEXTPLANE_VERSION_STRING "([^"]+)"', text)[1]


setup(
    name="textplane",
    version=version(),
    description="Planar text features for visual SLAM: kernels and solvers on NumPy arrays",
    license="BSD-3-Clause",
    python_requires=">=3.9",
    install_requires=["numpy"],
    packages=["textplane"],
    package_data={"textplane": ["py.typed", "*.pyi"]},
    ext_modules=[Extension("textplane._core", [])],
    cmdclass={"build_ext": CMakeBuild},
    zip_safe=False,
)
