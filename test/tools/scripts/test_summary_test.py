#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The edgesplat authors
# SPDX-License-Identifier: Apache-2.0
"""tools/lib/test_summary.py counts right and fails when it must.  usage: test_summary_test.py FOLDER_OF_THE_SCRIPT"""
import contextlib
import io
import os
import sys
import tempfile
import unittest

sys.path.insert(0, sys.argv.pop(1))
import test_summary  # noqa: E402

PASSED = '<testcase name="a/B.passes" status="run"/>'
FAILED = ('<testcase name="a/B.fails" status="fail"><failure message=""/><system-out>x.cpp:3: Failure\nboom'
          '</system-out></testcase>')
SKIPPED = ('<testcase name="a/B.skips" status="notrun"><skipped message="SKIP_REGULAR_EXPRESSION_MATCHED"/><system-out>'
           '/p/x.cpp:7: Skipped\nno GPU here\n\n[  SKIPPED ] B.skips (0 ms)</system-out></testcase>')
NOT_BUILT = ('<testcase name="a/B.lost" status="notrun"><skipped message="Unable to find executable"/>'
             '</testcase>')


class Summary(unittest.TestCase):
    def run_on(self, cases, allowed=""):
        with tempfile.TemporaryDirectory() as folder:
            results, skips = os.path.join(folder, "tests-dev.xml"), os.path.join(folder, "allowed.txt")
            with open(results, "w", encoding="utf-8") as file:
                file.write("<testsuite>" + "".join(cases) + "</testsuite>")
            with open(skips, "w", encoding="utf-8") as file:
                file.write(allowed)
            output = io.StringIO()
            with contextlib.redirect_stdout(output):
                status = test_summary.main([skips, results])
            return status, output.getvalue()

    def test_all_passed(self):
        status, output = self.run_on([PASSED, PASSED])
        self.assertEqual(status, 0)
        self.assertTrue(output.endswith("\n2 passed, 0 failed, 0 skipped\n") or output == "2 passed, 0 failed, 0 skipped\n")

    def test_a_failure_fails_and_shows_its_output(self):
        status, output = self.run_on([PASSED, FAILED])
        self.assertEqual(status, 1)
        self.assertIn("boom", output)
        self.assertIn("1 passed, 1 failed, 0 skipped", output)

    def test_an_unlisted_skip_fails(self):
        status, output = self.run_on([PASSED, SKIPPED])
        self.assertEqual(status, 1)
        self.assertIn("no GPU here", output)
        self.assertIn("not allowed to be skipped: a/B.skips", output)

    def test_a_listed_skip_passes(self):
        status, output = self.run_on([PASSED, SKIPPED], "# comment\na/*.skips needs a GPU\n")
        self.assertEqual(status, 0)
        self.assertIn("1 passed, 0 failed, 1 skipped", output)

    def test_a_test_that_was_never_built_is_a_failure(self):
        status, output = self.run_on([PASSED, NOT_BUILT], "* anything\n")
        self.assertEqual(status, 1)
        self.assertIn("1 passed, 1 failed, 0 skipped", output)

    def test_no_test_at_all_is_a_failure(self):
        self.assertEqual(self.run_on([])[0], 1)

    def test_an_allowed_skip_needs_its_reason(self):
        with self.assertRaises(SystemExit):
            self.run_on([PASSED], "a/B.skips\n")


if __name__ == "__main__":
    unittest.main()
