#!/usr/bin/env python3
"""The script that makes the single header: what it expands, and that it notices a change. Run as single_header_test.py ROOT."""
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(sys.argv.pop())


class Amalgamate(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        shutil.copytree(ROOT / "include", self.root / "include")
        shutil.copytree(ROOT / "single_include", self.root / "single_include")
        shutil.copy(ROOT / "LICENSE", self.root)
        self.header = self.root / "single_include/textplane.hpp"

    def run_script(self, *arguments):
        script = self.root / "single_include/amalgamate.py"
        return subprocess.run([sys.executable, script, *arguments], capture_output=True, text=True)

    def edit(self, name, old, new):
        path = self.root / "include/textplane" / name
        text = path.read_text(encoding="utf-8")
        self.assertIn(old, text)
        path.write_text(text.replace(old, new, 1), encoding="utf-8")

    def test_check_notices_a_change(self):
        self.assertEqual(self.run_script("--check").returncode, 0)
        self.edit("simd/kernels/halve.inl", "\n", "\n\n")
        stale = self.run_script("--check")
        self.assertEqual(stale.returncode, 1)
        self.assertEqual(len(stale.stderr.splitlines()), 1)
        self.assertEqual(self.run_script().returncode, 0)
        self.assertEqual(self.run_script("--check").returncode, 0)

    def test_headers_once_and_bodies_for_every_target(self):
        text = self.header.read_text(encoding="utf-8")
        # Not assertNotRegex(), which would print the header.
        self.assertIsNone(re.search(r'^\s*#\s*include\s+["<]textplane', text, re.M))
        umbrella = (ROOT / "include/textplane/textplane.hpp").read_text(encoding="utf-8")
        for name in re.findall(r'#include "(textplane/[^"]+)"', umbrella):
            guard = name.upper().replace("/", "_").replace(".", "_")
            self.assertEqual(text.count(f"#define {guard}\n"), 1, name)
        self.assertEqual(text.count("TEXTPLANE_SIMD_ENTRY void halve("), 6)
        for target in ("scalar", "sse41", "avx2", "avx512", "neon", "simd128"):
            body = (ROOT / f"include/textplane/simd/ops/{target}.inl").read_text(encoding="utf-8")
            line = next(x for x in body.splitlines() if x.startswith("TEXTPLANE_SIMD_INLINE vf load"))
            self.assertTrue(line in text, line)

    def test_what_it_cannot_expand_is_an_error(self):
        include = '#include "textplane/core/numeric.hpp"'
        for old, new, message in ((include, "#if 1\n" + include + "\n#endif", "under a condition"),
                                  (include, '#include "textplane/core/nothing.hpp"', "does not exist")):
            self.edit("core/se3.hpp", old, new)
            failed = self.run_script()
            self.assertEqual(failed.returncode, 2)
            self.assertIn("include/textplane/core/se3.hpp:", failed.stderr)
            self.assertIn(message, failed.stderr)
            self.edit("core/se3.hpp", new, old)


if __name__ == "__main__":
    unittest.main()
