#!/usr/bin/env python3
"""Every header includes, itself or through others, what declares the names that it uses. Run as
header_includes_test.py ROOT [--removals N].

It reads names, it compiles nothing: seconds where compiling every header alone takes minutes
(TEXTPLANE_TEST_INCLUDE_ALONE, which scripts/test --all does). With --removals it takes N single includes away, one at a
time, and prints how many of these faults it sees.
"""
import pathlib
import random
import re
import sys

ROOT = pathlib.Path(sys.argv[1])
# Names of the standard library and of Eigen that headers use, and the headers that declare them.
STANDARD = {
    "algorithm": "clamp copy count count_if equal fill fill_n find_if lower_bound max max_element min min_element minmax "
                 "none_of nth_element all_of any_of partition remove_if reverse rotate sort stable_sort swap_ranges "
                 "transform unique upper_bound",
    "array": "array", "atomic": "atomic atomic_flag", "bitset": "bitset", "chrono": "chrono",
    "cmath": "abs acos asin atan atan2 cbrt ceil copysign cos exp fabs floor fma fmod hypot isfinite isnan ldexp log "
             "lround nearbyint pow round sin sqrt tan trunc",
    "cstddef": "byte nullptr_t ptrdiff_t size_t", "cstdint": "int16_t int32_t int64_t int8_t intptr_t uint16_t uint32_t "
    "uint64_t uint8_t uintptr_t", "cstdlib": "getenv free malloc", "cstring": "memcpy memmove memset memcmp strcmp strlen",
    "deque": "deque", "functional": "function", "initializer_list": "initializer_list", "iterator": "back_inserter",
    "limits": "numeric_limits", "list": "list", "map": "map multimap", "memory": "make_shared make_unique shared_ptr "
    "unique_ptr", "mutex": "mutex lock_guard unique_lock", "new": "align_val_t nothrow bad_alloc",
    "numeric": "accumulate inner_product iota", "optional": "nullopt optional", "random": "mt19937",
    "set": "set", "string": "string to_string", "string_view": "string_view", "thread": "thread", "tuple": "tuple "
    "make_tuple tie", "type_traits": "conditional_t decay_t enable_if_t false_type is_arithmetic_v is_base_of_v "
    "is_convertible_v is_empty_v is_floating_point_v is_integral_v is_invocable_v is_nothrow_constructible_v is_same_v "
    "is_trivially_copyable_v remove_const_t remove_cv_t remove_reference_t true_type void_t", "unordered_map":
    "unordered_map", "unordered_set": "unordered_set", "utility": "declval exchange move pair swap forward "
    "index_sequence make_index_sequence make_pair", "vector": "vector"}
GEOMETRY = re.compile("AngleAxis|Hyperplane|Quaternion|Isometry|Affine")
CODE = re.compile(r'//[^\n]*|/\*.*?\*/|"(?:[^"\\\n]|\\.)*"|\'(?:[^\'\\\n]|\\.)+\'', re.S)
DIRECTIVE = re.compile(r"^[ \t]*#(?:[^\n\\]|\\\n|\\.)*", re.M)
INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]+[<"]([^>"]+)[>"]', re.M)
DECLARED = re.compile(r"\b(?:class|struct|enum class|enum|union)\s+(?:alignas\([^)]*\)\s*)?(?:TEXTPLANE_\w+\s+)*([A-Z]\w*)"
                      r"|\busing\s+(\w+)\s*=|(?<![\w.>:])(?!operator\b|alignas\b|requires\b|decltype\b|static_assert\b)"
                      r"([a-z]\w*|[A-Z]\w*)\s*(?=\()|\b(k[A-Z]\w*)\b\s*(?:\[[^]]*\]\s*)?[={]")
USED = re.compile(r"(\bstd::|\bEigen::|(?:\.|->|::)\s*)?\b([A-Za-z_]\w*)\b(?=\s*(\(|<|\{|::)?)")
# What a body, a class or a template's parameters declare.
OWN = re.compile(r"(?:\b(?:class|struct|enum|union|using|typename)\s+|(?!return\b|else\b|case\b|throw\b)\b\w+[>&*]*\s+[&*]*)"
                 r"([A-Za-z_]\w*)")
PARAMETERS = re.compile(r"\btemplate\s*<[^<>]*>")
TELLING = re.compile(r"[A-Z]\w+[a-z]\w*$|[a-z]+_\w+$|k[A-Z]\w+$")  # others name members and variables, too


def namespace_scope(code):
    """The text outside all braces and parentheses but those of namespaces; of a body, {} is left."""
    out, depth = [], []
    for part in re.split(r"(namespace\s*\w*\s*\{|[{}()])", code):
        if part.startswith("namespace"):
            depth.append("n")
        elif part in ("{", "("):
            if depth.count("n") == len(depth):
                out.append(part)
            depth.append(part)
        elif part in ("}", ")"):
            if depth:
                depth.pop()
            if depth.count("n") == len(depth):
                out.append(part)
        elif depth.count("n") == len(depth):
            out.append(part)
    return "".join(out)


def names(code):
    return {name for found in DECLARED.findall(code) for name in found if name}


class Header:
    """What a file includes, declares and uses."""

    def __init__(self, text, folder):
        # An adapter names its neighbours without a folder.
        self.includes = [f"{folder}/{name}" if "/" not in name and name.endswith(".hpp") else name
                         for name in INCLUDE.findall(text)]
        code = CODE.sub(lambda found: '""' if found[0][0] == '"' else " ", text)
        self.macros = set(re.findall(r"^[ \t]*#[ \t]*define[ \t]+(TEXTPLANE_\w+)", code, re.M))
        self.macros_used = set(re.findall(r"\bTEXTPLANE_\w+", re.sub(r"^[ \t]*#.*", "", code, flags=re.M)))
        code = DIRECTIVE.sub("", code)
        self.declares = names(PARAMETERS.sub("", namespace_scope(code)))
        own = set(OWN.findall(code))
        self.uses = {(scope[:-2] if scope in ("std::", "Eigen::") else "", name) for scope, name, after in USED.findall(code)
                     if scope in ("std::", "Eigen::") or (not scope and name not in own and TELLING.match(name) and
                                                          (name[0].isupper() or name[0] == "k" or after in ("(", "<")))}


class Headers:
    def __init__(self, texts):
        self.files = {name: Header(text, name.rsplit("/", 1)[0]) for name, text in texts.items()}
        self.standard = {name: header for header, listed in STANDARD.items() for name in listed.split()}
        self.owners, self.macro_owners = {}, {}
        for name, file in self.files.items():
            for declared in file.declares if name.endswith(".hpp") else ():
                self.owners.setdefault(declared, set()).add(name)
            for macro in file.macros:
                self.macro_owners.setdefault(macro, set()).add(name)

    def reached(self, name, seen=None):
        """All files that including this one includes."""
        seen = set() if seen is None else seen
        if name not in seen:
            seen.add(name)
            for included in self.files[name].includes if name in self.files else ():
                self.reached(included, seen)
        return seen

    def faults(self, name):
        file, reached = self.files[name], self.reached(name)
        for scope, used in sorted(file.uses):
            if scope == "std":
                if used in self.standard and self.standard[used] not in file.includes:
                    yield f"uses std::{used} and does not include <{self.standard[used]}>"
            elif scope == "Eigen":
                if GEOMETRY.match(used) and "Eigen/Geometry" not in reached:
                    yield f"uses Eigen::{used} and does not include <Eigen/Geometry>"
            elif used in self.owners and not self.owners[used] & reached:
                yield f"uses {used} and does not include {' or '.join(sorted(self.owners[used]))}"
        for macro in sorted(file.macros_used - file.macros):
            if macro in self.macro_owners and not self.macro_owners[macro] & reached:
                yield f"uses {macro} and does not include {' or '.join(sorted(self.macro_owners[macro]))}"


def removals(texts, count):
    """How many of `count` single includes of our own or of a standard header are missed when they are taken away."""
    random.seed(1)
    headers = Headers(texts)
    every = [(name, included) for name, file in headers.files.items() if name.endswith(".hpp") for included in file.includes]
    seen = 0
    for name, included in random.sample(every, min(count, len(every))):
        pattern = r'#[ \t]*include[ \t]+[<"](?:%s)[>"]' % re.escape(included)
        without = re.sub(pattern, "", texts[name])
        file, headers.files[name] = headers.files[name], Header(without, name.rsplit("/", 1)[0])
        fault = next(headers.faults(name), None)
        headers.files[name] = file
        seen += fault is not None
        print(f"{name} without {included}: {fault or 'no fault'}")
    print(f"{seen} of {count} seen")


def self_test():
    """Faults of each kind are seen, and what is none is not."""
    texts = {"textplane/a.hpp": "#define TEXTPLANE_A 1\nnamespace t {\nstruct Alpha { int beta_gamma; };\n"
                                "int do_it(int x) { return other_thing(x); }\n}\n",
             "textplane/b.hpp": '#include "textplane/a.hpp"\n', "textplane/c.hpp": '#include "textplane/b.hpp"\nAlpha a;\n',
             "textplane/d.hpp": "Alpha a; // do_it(1)\n", "textplane/e.hpp": "int b() { return do_it(TEXTPLANE_A) + x.do_it(1); }\n",
             "textplane/f.hpp": "std::vector<int> v;\n", "textplane/g.hpp": "Eigen::Quaternionf q; "
                                "int do_so() { struct Alpha {}; Alpha a; }\n"}
    found = {name[10]: list(Headers(texts).faults(name)) for name in texts}
    assert not found["a"] and not found["b"] and not found["c"], found
    assert found["d"] == ["uses Alpha and does not include textplane/a.hpp"], found
    assert len(found["e"]) == 2 and "do_it" in found["e"][0] and "TEXTPLANE_A" in found["e"][1], found
    assert found["f"] == ["uses std::vector and does not include <vector>"], found
    assert found["g"] == ["uses Eigen::Quaternionf and does not include <Eigen/Geometry>"], found


def main():
    self_test()
    folder = ROOT / "include"
    paths = sorted([*(folder / "textplane").rglob("*.hpp"), *(folder / "textplane").rglob("*.inl")])
    if len(paths) < 50:
        sys.exit(f"only {len(paths)} files below {folder}")
    texts = {path.relative_to(folder).as_posix(): path.read_text(encoding="utf-8") for path in paths}
    if sys.argv[2:3] == ["--removals"]:
        removals(texts, int(sys.argv[3]))
        return
    headers = Headers(texts)
    faults = [f"{folder / name}: {fault}" for name in texts if name.endswith(".hpp") for fault in headers.faults(name)]
    print("\n".join(faults) if faults else f"{len(texts)} files checked")
    sys.exit(1 if faults else 0)


main()
