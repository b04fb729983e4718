# SPDX-FileCopyrightText: 2026 The edgesplat authors
# SPDX-License-Identifier: Apache-2.0
"""quality_plot_test.py FOLDER: tests the quality_plot.py of that folder; drawing needs matplotlib and is skipped without it."""
import importlib.util
import pathlib
import sys
import tempfile
import unittest

FOLDER = pathlib.Path(sys.argv.pop(1))
sys.path.insert(0, str(FOLDER))
import quality_plot  # noqa: E402  pylint: disable=wrong-import-position

HEAD = "seconds,iterations,gaussians,psnr_db,ssim,lpips\n"


class QualityPlot(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def write(self, text):
        path = pathlib.Path(self.folder.name) / "curve.csv"
        path.write_text(text, encoding="utf-8")
        return path

    def test_reads_a_curve(self):
        curve = quality_plot.read_curve(self.write(HEAD + "1.0,10,100,20.5,0.7,0.4\n2.5,30,90,22,0.8,0.3\n"))
        self.assertEqual(curve["seconds"], [1.0, 2.5])
        self.assertEqual(curve["psnr_db"], [20.5, 22.0])
        self.assertEqual(curve["lpips"], [0.4, 0.3])

    def test_reads_a_curve_without_lpips(self):
        self.assertEqual(quality_plot.read_curve(self.write(HEAD + "1.0,10,100,20.5,0.7,\n"))["lpips"], [])

    def test_refuses_what_is_no_curve(self):
        for text in ["", "a,b\n1,2\n", HEAD, HEAD + "2,1,1,1,1,1\n1,2,1,1,1,1\n", HEAD + "x,1,1,1,1,1\n"]:
            with self.assertRaises(ValueError, msg=repr(text)):
                quality_plot.read_curve(self.write(text))

    def test_parses_arguments(self):
        self.assertEqual(quality_plot.parse_argument("fox:before=a/b.csv"), ("fox", "before", "a/b.csv"))
        for bad in ["fox=a.csv", "fox:x", ":x=a", "fox:=a", "fox:x="]:
            with self.assertRaises(ValueError, msg=bad):
                quality_plot.parse_argument(bad)

    @unittest.skipUnless(importlib.util.find_spec("matplotlib"), "no matplotlib")
    def test_draws(self):
        curve = quality_plot.read_curve(self.write(HEAD + "1.0,10,100,20.5,0.7,0.4\n2.5,30,90,22,0.8,0.3\n"))
        out = pathlib.Path(self.folder.name) / "plot.svg"
        quality_plot.draw({"fox": {"before": curve, "after": curve}, "room": {"after": curve}}, out)
        self.assertIn("<svg", out.read_text(encoding="utf-8"))


if __name__ == "__main__":
    unittest.main()
