#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The edgesplat authors
# SPDX-License-Identifier: Apache-2.0
"""tools/lib/spills.py reads what ptxas says and fails when it must.  usage: spills_test.py FOLDER_OF_THE_SCRIPT"""
import contextlib
import io
import os
import sys
import tempfile
import unittest

sys.path.insert(0, sys.argv.pop(1))
import spills  # noqa: E402

SAID = """ptxas info    : 11 bytes gmem
ptxas info    : Compiling entry function '_Z12blend_kernel5Frame' for 'sm_87'
ptxas info    : Function properties for _Z12blend_kernel5Frame
    0 bytes stack frame, 0 bytes spill stores, 0 bytes spill loads
ptxas info    : Used 56 registers, used 1 barriers, 12288 bytes smem
ptxas info    : Compile time = 12.000 ms
ptxas info    : Compiling entry function '_Z21blend_backward_kernelILb1EE' for 'sm_90'
ptxas info    : Function properties for _Z21blend_backward_kernelILb1EE
    24 bytes stack frame, 8 bytes spill stores, 16 bytes spill loads
ptxas info    : Used 255 registers, used 1 barriers
"""


class Spills(unittest.TestCase):
    def run_on(self, *names):
        with tempfile.TemporaryDirectory() as folder:
            file = os.path.join(folder, "said.txt")
            with open(file, "w", encoding="utf-8") as said:
                said.write(SAID)
            output = io.StringIO()
            with contextlib.redirect_stdout(output):
                status = spills.main(["--read", file, *names])
            return status, output.getvalue()

    def test_reads_the_figures(self):
        kernels = spills.parse(SAID)
        self.assertEqual([kernel["architecture"] for kernel in kernels], ["sm_87", "sm_90"])
        self.assertEqual([kernel["registers"] for kernel in kernels], [56, 255])
        self.assertEqual([kernel["shared"] for kernel in kernels], [12288, 0])
        self.assertEqual([kernel["spilled"] for kernel in kernels], [0, 24])

    def test_no_spill_passes(self):
        status, output = self.run_on("blend_kernel")
        self.assertEqual(status, 0)
        self.assertIn("56 registers", output)

    def test_a_spill_fails(self):
        status, output = self.run_on("blend_kernel", "blend_backward_kernel")
        self.assertEqual(status, 1)
        self.assertIn("spilled 24 bytes  SPILLS", output)

    def test_a_kernel_that_is_not_there_fails(self):
        self.assertEqual(self.run_on("blend_kernel", "gone_kernel")[0], 1)


if __name__ == "__main__":
    unittest.main()
