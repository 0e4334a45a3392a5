#!/usr/bin/env python3
"""Rules that headers keep for those who include them. Run as header_rules_test.py ROOT.

Macros have the prefix; matrices say how they are stored; there is no using-directive; outside adapters/ only Eigen and
the standard library are included, and no adapter; the one global object is the atomic of the dispatch. The version is the same wherever it is written.
"""
import pathlib
import re
import sys

ROOT = pathlib.Path(sys.argv[1])
INCLUDE = ROOT / "include/textplane"
ADAPTER_NEEDS = {"ceres": "ceres/", "ceres_pose": "ceres/", "ceres_text_rows": "ceres/",
                 "ceres_window": "ceres/", "ceres_text_map": "ceres/", "opencv": "opencv2/",
                 "opencv_lens": "opencv2/"}

SYSTEM = re.compile(r"(Eigen/(Core|Geometry)|c?[a-z_]+|([a-z]+[0-9]*[a-z]*intrin|intrin|arm_neon|wasm_simd128)\.h)$")
OBJECT = re.compile(r"^(inline |static |thread_local |extern )+(?!constexpr)[\w:<>,\s*&]+?\b(\w+)\s*"
                    r"(\{[^}]*\}|=[^=].*)?;", re.M)
# A matrix whose order of storage is left to EIGEN_DEFAULT_TO_ROW_MAJOR: neither side is 1, and no order follows.
UNORDERED = re.compile(r"Eigen::Matrix<[^,<>]+,(?!\s*1\s*,)[^,<>]+,(?!\s*1\s*[,>])[^,<>]+>"
                       r"|Eigen::(Matrix|Array)(XX?|[2-4]X?)[dfi]\b")
OBJECTS_ALLOWED = {"simd_target"}
VERSIONS = [("include/textplane/config.hpp", r'VERSION_STRING "([\d.]+)"'),
            ("CMakeLists.txt", r"project\(textplane VERSION ([\d.]+)"),
            ("package.xml", r"<version>([\d.]+)<"),
            ("CITATION.cff", r"^version: ([\d.]+)$")]


def without_comments(text):
    return re.sub(r"//[^\n]*", "", text)


def check(path):
    name = path.relative_to(INCLUDE).as_posix()
    text = without_comments(path.read_text(encoding="utf-8"))
    adapter = name.startswith("adapters/")
    needs = ADAPTER_NEEDS.get(path.stem) if adapter else None
    for number, line in enumerate(text.splitlines(), 1):
        macro = re.match(r"\s*#\s*define\s+(\w+)", line)
        if macro and not macro[1].startswith("TEXTPLANE_"):
            yield number, f"the macro {macro[1]} has no prefix"
        if re.search(r"\busing\s+namespace\b", line):
            yield number, "a using-directive"
        system = re.match(r"\s*#\s*include\s+<([^>]+)>", line)
        if system and not SYSTEM.match(system[1]) and not (needs and system[1].startswith(needs)):
            yield number, f"includes <{system[1]}>"
        own = re.match(r'\s*#\s*include\s+"([^"]+)"', line)
        if own and not own[1].startswith("textplane/") and not (adapter and (INCLUDE / "adapters" / own[1]).is_file()):
            yield number, f'includes "{own[1]}", which is not relative to include/'
        if own and not adapter and "adapters/" in own[1]:
            yield number, "includes an adapter"
        if UNORDERED.search(line):
            yield number, "a matrix that does not say how it is stored; FixedMatrix does"
    for found in OBJECT.finditer(text):
        if "(" not in found[0] and found[2] not in OBJECTS_ALLOWED:
            yield text[: found.start()].count("\n") + 1, f"the object {found[2]}"


def versions():
    """The version wherever it is written."""
    config = (INCLUDE / "config.hpp").read_text(encoding="utf-8")
    parts = [re.search(rf"define TEXTPLANE_VERSION_{part} (\d+)", config)[1] for part in ("MAJOR", "MINOR", "PATCH")]
    expected = ".".join(parts)
    for name, pattern in VERSIONS:
        found = re.search(pattern, (ROOT / name).read_text(encoding="utf-8"), re.M)
        if not found or found[1] != expected:
            yield f"{ROOT / name}: says version {found and found[1]}, config.hpp {expected}"


def self_test():
    """The patterns find what they should."""
    code = "inline int a = 1;\nstatic std::vector<int> b;\ninline constexpr int c = 1;\ninline int d() {\n"
    objects = [m[2] for m in OBJECT.finditer(code)]
    assert objects == ["a", "b"], objects
    assert SYSTEM.match("vector") and SYSTEM.match("Eigen/Core")
    assert UNORDERED.search("Eigen::Matrix<double, 3, 3>") and UNORDERED.search("Eigen::Matrix4d m;")
    assert not UNORDERED.search("Eigen::Matrix<S, 3, 1> Eigen::Matrix<S, 7, 6, Eigen::RowMajor> Eigen::Matrix<S, 1, 4>")
    assert not SYSTEM.match("Eigen/Dense") and not SYSTEM.match("opencv2/core.hpp")


def main():
    self_test()
    paths = sorted([*INCLUDE.rglob("*.hpp"), *INCLUDE.rglob("*.inl")])
    if len(paths) < 50:
        sys.exit(f"only {len(paths)} files below {INCLUDE}")
    faults = [f"{path}:{number}: {fault}" for path in paths for number, fault in check(path)]
    faults += versions()
    print("\n".join(faults) if faults else f"{len(paths)} files checked")
    sys.exit(1 if faults else 0)


main()
