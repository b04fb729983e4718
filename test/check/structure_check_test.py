#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The edgesplat authors
# SPDX-License-Identifier: Apache-2.0
"""The structure check finds what it is there to find."""
import os
import tempfile
import unittest

import structure_check

SPDX = "// SPDX-FileCopyrightText: 2026 x\n// SPDX-License-Identifier: Apache-2.0\n"


class IncludeRules(unittest.TestCase):
    def refused(self, source, target):
        self.assertIsNotNone(structure_check.include_violation(source, target), f"{source} -> {target}")

    def allowed(self, source, target):
        self.assertIsNone(structure_check.include_violation(source, target), f"{source} -> {target}")

    def test_tiers(self):
        self.allowed("robot/sync/a.cpp", "common/time/time.hpp")
        self.allowed("robot/render/a.cpp", "kernels/splat/splat.hpp")
        self.allowed("tools/desk/a.cpp", "robot/tracking/tracker.hpp")
        self.allowed("test/x.cpp", "server/app/server.hpp")
        self.refused("robot/map/a.cpp", "server/stream/stream.hpp")
        self.refused("server/stream/a.cpp", "robot/map/map.hpp")
        self.refused("common/io/a.cpp", "kernels/core/backend.hpp")
        self.refused("kernels/core/a.cpp", "robot/sync/sync.hpp")

    def test_common_levels(self):
        self.allowed("common/io/a.cpp", "common/map/keyframe.hpp")
        self.allowed("common/io/a.cpp", "common/io/b.hpp")
        self.refused("common/base/a.cpp", "common/time/time.hpp")
        self.refused("common/geometry/a.cpp", "common/sensor/rig.hpp")
        self.refused("common/io/a.cpp", "common/link/transport.hpp")
        self.refused("common/unheard_of/a.cpp", "common/base/result.hpp")

    def test_drivers_and_apps(self):
        self.allowed("robot/drivers/livox/a.cpp", "robot/drivers/livox/b.hpp")
        self.refused("robot/drivers/livox/a.cpp", "robot/sync/measure_group.hpp")
        self.refused("robot/drivers/livox/a.cpp", "kernels/core/backend.hpp")
        self.refused("robot/sync/a.cpp", "robot/app/run.hpp")
        self.allowed("robot/app/a.cpp", "robot/app/run.hpp")


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

    def test_headers(self):
        files = {"common/a.hpp": SPDX + "#pragma once\n", "common/b.hpp": SPDX, "common/c.cpp": "int x;\n"}
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
