#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The edgesplat authors
# SPDX-License-Identifier: Apache-2.0
"""tools/lib/gpu_table.py prints what was measured and nothing else.  usage: gpu_table_test.py FOLDER_OF_THE_SCRIPT"""
import contextlib
import io
import json
import os
import sys
import tempfile
import unittest

sys.path.insert(0, sys.argv.pop(1))
import gpu_table  # noqa: E402

DEVICE = {"device": "a card, sm_90", "copy_gb_per_s": 2990.4, "rounds": 20}
SCENE = {"resident": 1500000, "width_px": 1280, "height_px": 1024, "sh_degree": 3, "visible": 500000, "tile_pairs": 3000000, "forward_ms": 1.5,
         "forward_half_ms": 1.25,         "frame_bytes": 422000000, "limit_ms": 0.14, "forward_by_limit": 10.7, "iteration_ms": 6.0, "iteration_ordered_ms": 7.0,
         "iteration_peak_mib": 2000.4}
GSPLAT = {"resident": 1500000, "visible": 500000, "sh_degree": 3, "forward_ms": 3.0, "iteration_ms": 9.0, "psnr_db": 51.23, "ssim": "fused_ssim"}
NCU = '''==PROF== Connected
"ID","Kernel Name","Metric Name","Metric Unit","Metric Value"
"0","blend_kernel(Frame)","smsp__inst_executed.sum","inst","100,000,000"
"1","blend_kernel(Frame)","smsp__inst_executed.sum","inst","300,000,000"
"2","cull_kernel(Frame)","smsp__inst_executed.sum","inst","5,000,000"
'''


class GpuTable(unittest.TestCase):
    def run_on(self, files):
        with tempfile.TemporaryDirectory() as folder:
            for name, text in files.items():
                with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
                    file.write(text)
            output = io.StringIO()
            with contextlib.redirect_stdout(output):
                status = gpu_table.main([folder])
            return status, output.getvalue()

    def test_a_row_for_each_scene(self):
        status, output = self.run_on({"bench.jsonl": json.dumps(DEVICE) + "\n" + json.dumps(SCENE) + "\n"})
        self.assertEqual(status, 0)
        self.assertIn("a card, sm_90: copies 2990 GB/s", output)
        self.assertIn("| 1500000 | 1280x1024 | 3 | 500000 | 3000000 | 1.500 | 1.250 | 0.140 | 10.7 | 422 | 6.000 | 7.000 | 2000 |", output)
        self.assertNotIn("gsplat", output)

    def test_what_was_not_measured_is_a_dash(self):
        scene = {key: value for key, value in SCENE.items() if not key.startswith("iteration")}
        self.assertIn("| 422 | - | - | - |", self.run_on({"bench.jsonl": json.dumps(scene)})[1])

    def test_the_race_and_the_instructions(self):
        output = self.run_on({"bench.jsonl": json.dumps(SCENE), "gsplat.jsonl": json.dumps(GSPLAT), "ncu-0.csv": NCU})[1]
        self.assertIn("gsplat over edgesplat: forward 2.00, iteration 1.50", output)
        self.assertIn("51.2 dB", output)
        self.assertIn("200.00 M warp instructions a launch of blend_kernel", output)

    def test_no_figures_fail(self):
        self.assertEqual(self.run_on({})[0], 1)


if __name__ == "__main__":
    unittest.main()
