#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The edgesplat authors
# SPDX-License-Identifier: Apache-2.0
"""What the kernels of CUDA sources take of the hardware, by `ptxas -v`; fails where one of those named spills registers.

usage: spills.py BUILD_FOLDER KERNEL...      compiles again the sources whose kernels have these names, as the build does
       spills.py --read FILE KERNEL...       reads what `ptxas -v` said
A KERNEL is a part of its name: blend_kernel. Prints a line for each kernel and architecture. Exit code 1: a kernel spills or was
not found.
"""
import json
import os
import re
import shlex
import shutil
import subprocess
import sys

ENTRY = re.compile(r"Compiling entry function '(\S+)' for '(\w+)'")
SPILLS = re.compile(r"(\d+) bytes stack frame, (\d+) bytes spill stores, (\d+) bytes spill loads")
USED = re.compile(r"Used (\d+) registers(?:.*?(\d+) bytes smem)?")


def parse(text):
    """One dictionary for each kernel and architecture."""
    kernels = []
    for line in text.splitlines():
        if found := ENTRY.search(line):
            kernels.append({"name": found[1], "architecture": found[2], "registers": None, "shared": 0, "stack": 0, "spilled": None})
        elif kernels and (found := SPILLS.search(line)) and kernels[-1]["spilled"] is None:
            kernels[-1]["stack"] = int(found[1])
            kernels[-1]["spilled"] = int(found[2]) + int(found[3])
        elif kernels and (found := USED.search(line)) and kernels[-1]["registers"] is None:
            kernels[-1]["registers"] = int(found[1])
            kernels[-1]["shared"] = int(found[2] or 0)
    return kernels


def compile_again(build, names):
    with open(os.path.join(build, "compile_commands.json"), encoding="utf-8") as file:
        commands = json.load(file)
    text = ""
    for command in commands:
        source = os.path.join(command["directory"], command["file"])
        if not source.endswith(".cu") or " -x cu " not in command["command"]:
            continue  # the tests compile the same sources as C++
        with open(source, encoding="utf-8") as file:
            words = file.read()
        if not any(re.search(rf"__global__[^;{{]*\b{name}\b", words) for name in names):
            continue
        arguments = shlex.split(command["command"])
        arguments[arguments.index("-o") + 1] = os.devnull
        ran = subprocess.run([*arguments, "-Xptxas=-v"], cwd=command["directory"], capture_output=True, text=True, check=False)
        if ran.returncode != 0:
            sys.exit(f"{source} does not compile:\n{ran.stdout}{ran.stderr}")
        text += ran.stdout + ran.stderr
    return text


def short(name):
    """edgesplat::splat::(anonymous namespace)::blend_kernel(...) -> blend_kernel; as it is without c++filt."""
    if (program := shutil.which("c++filt")) is None:
        return name
    said = subprocess.run([program, name], capture_output=True, text=True, check=False).stdout.strip()
    without_namespaces = re.sub(r"^(?:void )?(?:\w+::|\(anonymous namespace\)::|_GLOBAL__N_\w*::)*", "", said)
    return without_namespaces.split("(")[0]


def main(arguments):
    if len(arguments) < 2 or arguments[0].startswith("-h") or (arguments[0] == "--read" and len(arguments) < 3):
        sys.exit(__doc__)
    if arguments[0] == "--read":
        names = arguments[2:]
        with open(arguments[1], encoding="utf-8") as file:
            text = file.read()
    else:
        names = arguments[1:]
        text = compile_again(arguments[0], names)
    failed = False
    kernels = parse(text)
    for name in names:
        found = [kernel for kernel in kernels if name in kernel["name"]]
        if not found:
            failed = True
            print(f"{name}: no such kernel")
        for kernel in found:
            wrong = kernel["spilled"] is None or kernel["spilled"] > 0
            failed = failed or wrong
            spilled = "unknown" if kernel["spilled"] is None else f"{kernel['spilled']} bytes"
            print(f"{short(kernel['name'])} {kernel['architecture']}: {kernel['registers']} registers, {kernel['shared']} bytes shared, "
                  f"{kernel['stack']} bytes stack, spilled {spilled}{'  SPILLS' if wrong else ''}")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
