#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The edgesplat authors
# SPDX-License-Identifier: Apache-2.0
"""tools/lib/jetson_libraries.py on made-up programs: what it refuses and why.  usage: jetson_libraries_test.py FOLDER"""
import contextlib
import io
import os
import sys
import tempfile
import unittest

TOOLS = sys.argv.pop(1)
sys.path.insert(0, TOOLS)
import jetson_libraries  # noqa: E402

LIST = """# a comment
limit JetPack-6 GLIBC 2.35
limit JetPack-6 GLIBCXX 3.4.30
limit JetPack-7.2 GLIBC 2.39
limit JetPack-7.2 GLIBCXX 3.4.33
device libc.so.6
device libstdc++.so.6
shipped libspdlog.so.1.10  # the log
shipped libfmt.so.9
"""

NEEDS = """
Version symbols section '.gnu.version' contains 2 entries:
  000:   0 (*local*)       2 (GLIBC_2.99)
Version needs section '.gnu.version_r' contains {count} entries:
 Addr: 0x0000000000000508  Offset: 0x00000508  Link: 7 (.dynstr)
"""


def elf(needed=(), versions=(), rpath="$ORIGIN/../lib", tag="RPATH", machine="AArch64"):
    """What readelf says about a program: {option: text}."""
    dynamic = "".join(f" 0x0000000000000001 (NEEDED)             Shared library: [{name}]\n" for name in needed)
    if rpath:
        dynamic += f" 0x000000000000000f ({tag})              Library rpath: [{rpath}]\n"
    text = NEEDS.format(count=len(versions))
    for file, names in versions:
        text += f"  000000: Version: 1  File: {file}  Cnt: {len(names)}\n"
        for name in names:
            text += f"  0x0010:   Name: {name}  Flags: none  Version: 5\n"
    return {"-h": f"  Machine:                           {machine}\n", "-d": dynamic, "-V": text if versions else ""}


class JetsonLibraries(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.files = {}
        os.makedirs(os.path.join(self.folder.name, "usr/lib/aarch64-linux-gnu"))
        self.readelf = jetson_libraries.readelf
        jetson_libraries.readelf = lambda option, path: self.files[os.path.basename(path)][option]
        self.write("list", LIST)
        self.library("libspdlog.so.1.10", elf(["libfmt.so.9", "libc.so.6"], rpath=""))
        self.library("libfmt.so.9", elf(["libstdc++.so.6"], [("libstdc++.so.6", ["GLIBCXX_3.4.29"])], rpath=""))

    def tearDown(self):
        jetson_libraries.readelf = self.readelf
        self.folder.cleanup()

    def write(self, name, text=""):
        path = os.path.join(self.folder.name, name)
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)
        return path

    def library(self, name, said):
        self.write(os.path.join("usr/lib/aarch64-linux-gnu", name), name)
        self.files[name] = said

    def run_on(self, said, verb="check", *more):
        self.files["robot"] = said
        out, err = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            status = jetson_libraries.main(["--list", os.path.join(self.folder.name, "list"), verb, self.folder.name, *more,
                                            self.write("robot")])
        return status, out.getvalue(), err.getvalue()

    def test_accepts_what_every_system_has(self):
        status, out, err = self.run_on(elf(["libspdlog.so.1.10", "libc.so.6"], [("libc.so.6", ["GLIBC_2.17", "GLIBC_2.34"])]))
        self.assertEqual(status, 0, err)
        self.assertIn("1 programs: 2 libraries are shipped, 2 are the device's", out)
        self.assertIn("GLIBC: 2.34 is needed; JetPack-6 has 2.35, JetPack-7.2 has 2.39", out)
        self.assertIn("GLIBCXX: 3.4.29 is needed", out)  # by a library of a library

    def test_compares_versions_as_numbers(self):
        self.assertEqual(self.run_on(elf(["libc.so.6"], [("libc.so.6", ["GLIBC_2.4"])]))[0], 0)
        status, _, err = self.run_on(elf(["libc.so.6"], [("libc.so.6", ["GLIBC_2.4", "GLIBC_2.36"])]))
        self.assertEqual(status, 1)
        self.assertIn("robot needs GLIBC_2.36 of libc.so.6; JetPack-6 has GLIBC_2.35 at most", err)
        self.assertNotIn("JetPack-7.2", err)

    def test_refuses_a_shipped_library_that_is_too_new(self):
        self.library("libfmt.so.9", elf(["libstdc++.so.6"], [("libstdc++.so.6", ["GLIBCXX_3.4.32"])], rpath=""))
        status, _, err = self.run_on(elf(["libspdlog.so.1.10"]))
        self.assertEqual(status, 1)
        self.assertIn("libfmt.so.9 needs GLIBCXX_3.4.32 of libstdc++.so.6; JetPack-6 has", err)

    def test_versions_of_a_shipped_library_are_its_own_affair(self):
        self.assertEqual(self.run_on(elf(["libfmt.so.9"], [("libfmt.so.9", ["GLIBC_9.9"])]))[0], 0)

    def test_refuses_versions_without_a_limit(self):
        status, _, err = self.run_on(elf(["libc.so.6"], [("libc.so.6", ["MUSL_1.2"])]))
        self.assertEqual(status, 1)
        self.assertIn("no limit of JetPack-6", err)

    def test_refuses_a_library_on_no_list(self):
        status, _, err = self.run_on(elf(["libnew.so.1"]))
        self.assertEqual(status, 1)
        self.assertIn("robot needs libnew.so.1, which jetson-libraries.txt does not name", err)

    def test_refuses_a_library_that_the_sysroot_lacks(self):
        os.remove(os.path.join(self.folder.name, "usr/lib/aarch64-linux-gnu/libfmt.so.9"))
        status, _, err = self.run_on(elf(["libspdlog.so.1.10"]))
        self.assertEqual(status, 1)
        self.assertIn("libfmt.so.9 is not in", err)

    def test_refuses_another_machine_and_another_rpath(self):
        for said, words in ((elf(machine="Advanced Micro Devices X86-64"), "not for AArch64"), (elf(rpath=""), "RPATH []"),
                            (elf(rpath="/elsewhere/lib"), "RPATH ['/elsewhere/lib']"),
                            (elf(tag="RUNPATH"), "RUNPATH ['$ORIGIN/../lib'], not")):
            status, _, err = self.run_on(said)
            self.assertEqual(status, 1)
            self.assertIn(words, err)

    def test_refuses_libraries_that_look_elsewhere(self):
        for rpath, wanted in (("$ORIGIN/../lib/aarch64-linux-gnu", 0), ("/usr/local/lib", 1)):
            self.library("libfmt.so.9", elf(rpath=rpath, tag="RUNPATH"))
            self.assertEqual(self.run_on(elf(["libfmt.so.9"]))[0], wanted, rpath)

    def test_refuses_a_list_that_contradicts_itself_or_says_nothing(self):
        for line in ("device libfmt.so.9\n", "limit JetPack-6 GLIBC\n", "perhaps libc.so.6\n"):
            self.write("list", LIST + line)
            status, _, err = self.run_on(elf(["libc.so.6"]))
            self.assertEqual(status, 1, line)
            self.assertIn("list:10", err)

    def test_bundles_programs_and_what_they_need(self):
        folder = os.path.join(self.folder.name, "bundle")
        status, _, err = self.run_on(elf(["libspdlog.so.1.10", "libc.so.6"]), "bundle", folder)
        self.assertEqual(status, 0, err)
        self.assertEqual(sorted(os.listdir(os.path.join(folder, "lib"))), ["aarch64-linux-gnu", "libfmt.so.9", "libspdlog.so.1.10"])
        self.assertTrue(os.path.exists(os.path.join(folder, "lib/aarch64-linux-gnu/libfmt.so.9")))  # Debian's runpath
        self.assertEqual(os.listdir(os.path.join(folder, "bin")), ["robot"])
        # A refusal leaves the old one as it was.
        self.assertEqual(self.run_on(elf(["libnew.so.1"]), "bundle", folder)[0], 1)
        self.assertEqual(os.listdir(os.path.join(folder, "bin")), ["robot"])

    def test_reads_programs_of_this_machine(self):
        jetson_libraries.readelf = self.readelf
        out = io.StringIO()
        with contextlib.redirect_stderr(out):
            self.assertEqual(jetson_libraries.main(["check", "/", TOOLS + "/jetson_libraries.py"]), 1)
            self.assertEqual(jetson_libraries.main(["check", "/"]), 2)
        self.assertIn("not a program or library", out.getvalue())

    def test_the_list_itself_is_sound(self):
        limits, places = jetson_libraries.read_list(os.path.join(TOOLS, "jetson-libraries.txt"))
        self.assertEqual(limits["JetPack-6"]["GLIBC"], (2, 35))
        self.assertEqual(limits["JetPack-7.2"]["GLIBC"], (2, 39))
        self.assertEqual({places[name] for name in ("libc.so.6", "libstdc++.so.6", "libgcc_s.so.1")}, {"device"})


if __name__ == "__main__":
    unittest.main()
