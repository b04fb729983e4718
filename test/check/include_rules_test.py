#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The edgesplat authors
# SPDX-License-Identifier: Apache-2.0
"""Each include rule refuses a bad sample and allows a good one."""
import unittest

from include_rules import include_problems


class IncludeDirections(unittest.TestCase):
    def assert_refused(self, path, include):
        self.assertTrue(include_problems(path, f"#include {include}"), f"{path} may not include {include}")

    def assert_allowed(self, path, include):
        self.assertEqual(include_problems(path, f"#include {include}"), [])

    def test_tops(self):
        self.assert_refused("common/io/a.cpp", '"kernels/core/backend.hpp"')
        self.assert_refused("kernels/splat/a.cpp", '"robot/sync/measure_group.hpp"')
        self.assert_refused("robot/sync/a.cpp", '"server/ingest/x.hpp"')
        self.assert_refused("server/ingest/a.cpp", '"robot/sync/x.hpp"')
        self.assert_refused("robot/app/a.cpp", '"tools/simulate/world.hpp"')
        self.assert_refused("tools/desk/a.cpp", '"test/support/random.hpp"')
        self.assert_allowed("robot/sync/a.cpp", '"common/sensor/rig.hpp"')
        self.assert_allowed("tools/desk/a.cpp", '"robot/sync/x.hpp"')
        self.assert_allowed("test/robot/sync/a.cpp", '"tools/simulate/world.hpp"')

    def test_levels_of_common(self):
        self.assert_refused("common/base/a.hpp", '"common/time/time.hpp"')
        self.assert_refused("common/log/a.cpp", '"common/config/config_file.hpp"')
        self.assert_refused("common/sensor/a.cpp", '"common/gaussian/gaussian_cloud.hpp"')
        self.assert_refused("common/map/a.cpp", '"common/link/link.hpp"')
        self.assert_refused("common/nowhere/a.cpp", '"common/base/result.hpp"')
        self.assert_allowed("common/thread/a.hpp", '"common/time/clock.hpp"')
        self.assert_allowed("common/metrics/a.hpp", '"common/time/clock.hpp"')
        self.assert_allowed("common/base/a.hpp", '"common/base/result.hpp"')

    def test_order_of_the_stages(self):
        self.assert_refused("robot/sync/a.cpp", '"robot/tracking/tracker.hpp"')
        self.assert_refused("robot/tracking/a.cpp", '"robot/app/wiring.hpp"')
        self.assert_refused("server/ingest/a.cpp", '"server/stream/x.hpp"')
        self.assert_refused("robot/unknown/a.cpp", '"robot/sync/x.hpp"')
        self.assert_allowed("robot/tracking/a.cpp", '"robot/sync/measure_group.hpp"')
        self.assert_allowed("robot/app/a.cpp", '"robot/render/x.hpp"')

    def test_kernels(self):
        self.assert_refused("robot/drivers/livox/a.cpp", '"kernels/core/backend.hpp"')
        self.assert_refused("robot/render/a.cpp", '"kernels/mapping/seed.hpp"')
        self.assert_refused("robot/tracking/a.cpp", '"kernels/mapping/seed.hpp"')
        self.assert_allowed("robot/map/a.cpp", '"kernels/mapping/seed.hpp"')

    def test_outside_headers(self):
        self.assert_refused("robot/uplink/a.cpp", "<dds/dds.h>")
        self.assert_refused("robot/uplink/a.cpp", '"dds/dds.h"')
        self.assert_refused("robot/render/a.cpp", "<cuda_runtime.h>")
        self.assert_refused("robot/render/a.cpp", "<cub/cub.cuh>")
        self.assert_refused("robot/app/main.cpp", "<spdlog/spdlog.h>")
        self.assert_refused("common/config/a.cpp", "<spdlog/spdlog.h>")
        self.assert_refused("common/sensor/a.cpp", "<toml++/toml.h>")
        self.assert_allowed("common/link/a.cpp", '"dds/dds.h"')
        self.assert_allowed("test/common/link/a.cpp", '"dds/dds.h"')
        self.assert_allowed("kernels/splat/a.cu", "<cuda_runtime.h>")

    def test_names_the_line(self):
        (line, _), = include_problems("robot/a/b.cpp", "// x\n\n  #  include <dds/dds.h>\n")
        self.assertEqual(line, 3)


if __name__ == "__main__":
    unittest.main()
