#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The edgesplat authors
# SPDX-License-Identifier: Apache-2.0
"""The structure check finds what it is there to find."""
import os
import tempfile
import unittest

import structure_check

SPDX = "// SPDX-FileCopyrightText: 2026 x\n// SPDX-License-Identifier: Apache-2.0\n"


class FileRules(unittest.TestCase):
    def violations(self, rule, files):
        with tempfile.TemporaryDirectory() as root:
            for name, text in files.items():
                os.makedirs(os.path.dirname(os.path.join(root, name)), exist_ok=True)
                with open(os.path.join(root, name), "w", encoding="utf-8") as file:
                    file.write(text)
            names = structure_check.tracked_files(root)
            self.assertEqual(sorted(names), sorted(files))
            return list(structure_check.RULES[rule](root, names))

    def test_long_file(self):
        self.assertEqual(len(self.violations("sizes", {"common/a.cpp": "\n" * 501, "common/b.cpp": "\n" * 500})), 1)

    def test_long_readme(self):
        files = {"common/io/README.md": "\n" * 31, "common/map/README.md": "\n" * 30, "README.md": "\n" * 99}
        self.assertEqual(len(self.violations("sizes", files)), 1)

    def test_mirrors(self):
        files = {"common/base/a.cpp": SPDX, "robot/drivers/livox/a.cpp": SPDX, "test/common/base/CMakeLists.txt": "",
                 "test/common/CMakeLists.txt": "", "test/CMakeLists.txt": "", "test/robot/livox/CMakeLists.txt": "", "test/fuzz/CMakeLists.txt": "",
                 "test/common/ghost/CMakeLists.txt": ""}
        self.assertEqual(len(self.violations("mirrors", files)), 1)

    def test_cuda_files_live_in_kernels(self):
        files = {"robot/render/a.cu": SPDX, "kernels/splat/a.cu": SPDX}
        self.assertEqual(len(self.violations("includes", files)), 1)

    @unittest.skipUnless(structure_check.formatter(), "clang-format 14 is not installed")
    def test_format(self):
        files = {"common/a.cpp": SPDX + "int x;\n", "common/b.cpp": SPDX + "int   x  ;\n"}
        self.assertEqual(len(self.violations("format", files)), 1)

    def test_headers(self):
        files = {
            "common/a.hpp": SPDX + "#pragma once\n",
            "common/b.hpp": SPDX,
            "common/c.cpp": "int x;\n",
            "common/d-inl.hpp": SPDX + "#if defined(D) == defined(HWY_TARGET_TOGGLE)\n",
        }
        self.assertEqual(len(self.violations("headers", files)), 2)

    def test_includes_are_read_from_files(self):
        files = {"common/base/a.cpp": SPDX + '#include "robot/sync/x.hpp"\n#include <vector>\n'}
        self.assertEqual(len(self.violations("includes", files)), 1)

    def test_words(self):
        place = "/" + "home/somebody/x"
        files = {"robot/a.cpp": "std::this_thread" + "::sleep_for(x);", "docs/a.md": place, "docs/b.md": "fine"}
        self.assertEqual(len(self.violations("words", files)), 2)


if __name__ == "__main__":
    unittest.main()
