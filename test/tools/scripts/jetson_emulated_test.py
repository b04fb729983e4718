#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The edgesplat authors
# SPDX-License-Identifier: Apache-2.0
"""What the cross build made (build/jetson), under qemu-user. Exit code 77 where it is not there.

usage: jetson_emulated_test.py --source ROOT gtest BINARY              a test binary passes, on NEON
       jetson_emulated_test.py --source ROOT starts                    a device with the listed libraries alone starts the programs
       jetson_emulated_test.py --source ROOT trajectory --native BIN --seconds S
                                                                       the robot drives for S s as it does in BIN, within 1 mm
"""
import argparse
import json
import math
import os
import re
import shutil
import subprocess
import sys
import tempfile

SKIPPED = 77
MOST_APART_M = 1e-6  # asked is 1e-3; it is zero, and one bit in one place may grow to it in ten seconds


def skip(reason):
    print(f"SKIP: {reason}")
    sys.exit(SKIPPED)


class CrossBuild:
    """build/jetson of a checkout, the sysroot it was made with, and the emulator."""

    def __init__(self, source):
        self.tools = os.path.join(source, "tools/lib")
        self.bin = os.path.join(source, "build/jetson/bin")
        self.sysroot = os.environ.get("EDGESPLAT_SYSROOT") or os.path.join(source, ".deps/sysroot-aarch64")
        self.qemu = shutil.which("qemu-aarch64-static") or shutil.which("qemu-aarch64")
        if not self.qemu or not os.path.isdir(self.sysroot):
            skip("no aarch64 emulator or sysroot: run tools/setup --jetson")

    def program(self, name):
        path = os.path.join(self.bin, name)
        if not os.path.exists(path):
            skip(f"build/jetson/bin/{name} was not built: run tools/jetson, or ninja -C build/jetson {name}")
        return path

    def run(self, root, arguments, **more):
        return subprocess.run([self.qemu, "-L", root, *arguments], text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              check=False, **more)

    def libraries(self, *arguments):
        command = [sys.executable, "-B", os.path.join(self.tools, "jetson_libraries.py"), *arguments]
        done = subprocess.run(command, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
        print(done.stdout, end="")
        if done.returncode != 0:
            sys.exit(1)

    def installed(self, folder, *names):
        """The programs as they are installed on a device, and a root folder with a device's libraries alone."""
        sys.path.insert(0, self.tools)
        import jetson_libraries
        _, places = jetson_libraries.read_list(os.path.join(self.tools, "jetson-libraries.txt"))
        root, bundle = os.path.join(folder, "device"), os.path.join(folder, "edgesplat")
        self.libraries("bundle", self.sysroot, bundle, *map(self.program, names))
        os.makedirs(os.path.join(root, "lib/aarch64-linux-gnu"))
        for name in (name for name, place in places.items() if place == "device"):
            path = jetson_libraries.find_library(self.sysroot, name)
            shutil.copy(path, os.path.join(root, "lib/aarch64-linux-gnu", name))
            if name.startswith("ld-linux"):
                shutil.copy(path, os.path.join(root, "lib", name))
        return root, os.path.join(bundle, "bin")


def gtest(build, binary):
    program = build.program(binary)
    # Highway names what it compiles for each target: plain C++ (EMU128, SCALAR) would pass as well, some ten times slower.
    symbols = subprocess.run(["readelf", "-sW", program], text=True, stdout=subprocess.PIPE, check=True).stdout
    if "N_NEON" not in symbols or "N_EMU128" in symbols or "N_SCALAR" in symbols:
        sys.exit(f"{binary}: the kernels' loops are not NEON's")
    done = build.run(build.sysroot, [program, "--gtest_brief=1"])
    print(done.stdout[-6000:])
    passed = re.search(r"\[  PASSED  \] (\d+) tests?", done.stdout)
    if done.returncode != 0 or not passed or int(passed.group(1)) == 0:
        sys.exit(f"{binary}: exit code {done.returncode} on aarch64")


def starts(build):
    with tempfile.TemporaryDirectory() as folder:
        names = ("edgesplat-robot", "edgesplat")
        root, programs = build.installed(folder, *names)
        for name in names:
            done = build.run(root, [os.path.join(programs, name), "--version"])
            print(done.stdout, end="")
            if done.returncode != 0 or name not in done.stdout:
                sys.exit(f"{name} does not start with a device's libraries and those that come along")
        # The test could not fail if the emulator found libraries elsewhere.
        shutil.rmtree(os.path.join(os.path.dirname(programs), "lib"))
        done = build.run(root, [os.path.join(programs, "edgesplat-robot"), "--version"])
        if done.returncode == 0:
            sys.exit("edgesplat-robot starts without the libraries that come along: then the device's folder has them")


def poses(path):
    """[(stamp as written, x, y, z, qx, qy, qz, qw)] of a TUM file."""
    with open(path, encoding="utf-8") as lines:
        rows = [line.split() for line in lines if line.strip() and not line.startswith("#")]
    return [(row[0], *map(float, row[1:])) for row in rows]


def apart(one, other):
    """(metres, radians) between two poses."""
    cosine = min(1.0, abs(sum(a * b for a, b in zip(one[4:], other[4:]))))
    return math.dist(one[1:4], other[1:4]), 2 * math.acos(cosine)


def compare(native, emulated, seconds):
    """A sentence about two trajectories; raises ValueError where they are not the same drive."""
    if [pose[0] for pose in native] != [pose[0] for pose in emulated]:
        raise ValueError(f"{len(native)} poses on this machine and {len(emulated)} on aarch64, or other stamps")
    length = sum(math.dist(a[1:4], b[1:4]) for a, b in zip(native, native[1:]))
    if len(native) < 9 * seconds or length < 0.2 * seconds:
        raise ValueError(f"{len(native)} poses over {length:.2f} m are no drive to compare")
    metres, radians = map(max, zip(*(apart(a, b) for a, b in zip(native, emulated))))
    words = f"{len(native)} poses over {length:.2f} m: at most {metres * 1e3:.6f} mm and {math.degrees(radians):.6f} degrees apart"
    if not metres <= MOST_APART_M:
        raise ValueError(words)
    return words


def drive(run, robot, recording, out):
    done = run([robot, "--replay", recording, "--lockstep", "--threads", "2", "--server", "off", "--out", out])
    if done.returncode != 0:
        sys.exit(f"{robot} ends with exit code {done.returncode}:\n{done.stdout[-3000:]}")
    with open(os.path.join(out, "robot/metrics.json"), encoding="utf-8") as file:
        if not json.load(file)["counters"].get("tracking.visual_updates"):
            sys.exit(f"{robot}: the camera did not update the pose, so LiDAR and IMU alone would be compared")
    return poses(os.path.join(out, "robot/trajectory.tum"))


def trajectory(build, native_bin, seconds):
    with tempfile.TemporaryDirectory() as folder:
        root, programs = build.installed(folder, "edgesplat-robot")
        recording = os.path.join(folder, "corridor.mcap")

        def here(arguments):
            return subprocess.run(arguments, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)

        made = here([os.path.join(native_bin, "edgesplat"), "simulate", "--world", "corridor", "--seconds", str(seconds),
                     "--pedestrians", "2", "--seed", "3", "--out", recording])
        if made.returncode != 0:
            sys.exit(made.stdout)
        native = drive(here, os.path.join(native_bin, "edgesplat-robot"), recording, os.path.join(folder, "native"))
        emulated = drive(lambda arguments: build.run(root, arguments), os.path.join(programs, "edgesplat-robot"), recording,
                         os.path.join(folder, "emulated"))
        try:
            print(compare(native, emulated, seconds))
        except ValueError as problem:
            sys.exit(f"not the same trajectory: {problem}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--source", required=True)
    parser.add_argument("what", choices=("gtest", "starts", "trajectory"))
    parser.add_argument("binary", nargs="?")
    parser.add_argument("--native")
    parser.add_argument("--seconds", type=int, default=10)
    chosen = parser.parse_args()
    build = CrossBuild(chosen.source)
    if chosen.what == "gtest":
        gtest(build, chosen.binary)
    elif chosen.what == "starts":
        starts(build)
    else:
        trajectory(build, chosen.native, chosen.seconds)


if __name__ == "__main__":
    main()
