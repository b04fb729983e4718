#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The edgesplat authors
# SPDX-License-Identifier: Apache-2.0
"""Holds the rules of ARCHITECTURE.md and CONTRIBUTING.md that a machine can check.

usage: structure_check.py RULE [ROOT]      RULE: includes, mirrors, sizes, headers, format, words
Prints one line a violation; exit code 1 where there is one.
"""
import os
import re
import shutil
import subprocess
import sys

from include_rules import include_problems

SOURCE_ENDINGS = (".hpp", ".cpp", ".cu", ".cuh")
MAX_LINES = 500
MAX_README_LINES = 30
SKIPPED = 77  # what CTest knows as SKIP_RETURN_CODE
# Test folders that mirror no folder of the tree.
NOT_MIRRORED = ("test/support", "test/check", "test/integration", "test/fuzz", "test/bench", "test/tools/scripts")


def tracked_files(root):
    """What git tracks; in an unpacked archive everything but what a build leaves."""
    listed = subprocess.run(["git", "-c", "safe.directory=*", "-C", root, "ls-files", "-z"], capture_output=True, check=False)
    if listed.returncode == 0:
        names = [name for name in listed.stdout.decode().split("\0") if name]
        return [name for name in names if os.path.isfile(os.path.join(root, name))]
    names = []
    for folder, folders, files in os.walk(root):
        folders[:] = [name for name in folders if not name.startswith((".", "build")) and name not in ("out", "__pycache__")]
        names += [os.path.relpath(os.path.join(folder, name), root) for name in files]
    return sorted(names)


def read(root, name):
    with open(os.path.join(root, name), encoding="utf-8", errors="replace") as file:
        return file.read()


def check_includes(root, files):
    for name in files:
        if name.endswith(SOURCE_ENDINGS):
            for line, why in include_problems(name, read(root, name)):
                yield f"{name}:{line} includes {why}"
            if name.endswith((".cu", ".cuh")) and not name.startswith(("kernels/", "test/kernels/")):
                yield f"{name}: CUDA files live in kernels/ only"


def check_mirrors(root, files):
    """test/a/b tests a/b; the drivers' extra level would say nothing there."""
    folders = {os.path.dirname(name) for name in files if not name.startswith("test/")}
    for name in files:
        folder = os.path.dirname(name)
        if not name.endswith("/CMakeLists.txt") or not folder.startswith("test/") or folder.startswith(NOT_MIRRORED):
            continue
        mirrored = folder.removeprefix("test/")
        driver = mirrored.replace("/", "/drivers/", 1)
        if not any(known == place or known.startswith(place + "/") for known in folders for place in (mirrored, driver)):
            yield f"{folder} mirrors {mirrored}, which does not exist"


def check_sizes(root, files):
    for name in files:
        if name.endswith(SOURCE_ENDINGS):
            lines = read(root, name).count("\n")
            if lines > MAX_LINES:
                yield f"{name} has {lines} lines, more than {MAX_LINES}: split it"
        elif os.path.basename(name) == "README.md" and "/" in name and not name.startswith("docs/"):
            lines = read(root, name).count("\n")
            if lines > MAX_README_LINES:
                yield f"{name} has {lines} lines, more than {MAX_README_LINES}"
        elif not name.startswith("docs/") and os.path.getsize(os.path.join(root, name)) > 1 << 20:
            yield f"{name} is larger than 1 MiB"


def check_headers(root, files):
    for name in files:
        if not name.endswith(SOURCE_ENDINGS + (".py",)):
            continue
        text = read(root, name)
        first = [line for line in text.splitlines()[:4] if not line.startswith("#!")]
        if len(first) < 2 or "SPDX-FileCopyrightText:" not in first[0] or "SPDX-License-Identifier:" not in first[1]:
            yield f"{name} does not start with the two SPDX lines"
        # Highway includes -inl.hpp files once for each set of vector instructions.
        guard = "HWY_TARGET_TOGGLE" if name.endswith("-inl.hpp") else "#pragma once"
        if name.endswith((".hpp", ".cuh")) and guard not in text:
            yield f"{name} lacks {guard}"


def formatter():
    """clang-format 14: others break lines elsewhere."""
    for name in ("clang-format-14", "clang-format"):
        found = shutil.which(name)
        if found and "version 14." in subprocess.run([found, "--version"], capture_output=True, text=True, check=False).stdout:
            return found
    return None


def check_format(root, files):
    program = formatter()
    if program is None:
        print("SKIPPED: clang-format 14 is not installed (tools/setup installs it)")
        sys.exit(SKIPPED)
    sources = [name for name in files if name.endswith(SOURCE_ENDINGS)]
    found = subprocess.run([program, "--dry-run", *sources], cwd=root, capture_output=True, text=True, check=False)
    names = re.findall(r"^(\S+?):\d+:\d+: (?:warning|error): code should be clang-formatted", found.stderr, re.MULTILINE)
    for name in sorted(set(names)):
        yield f"{name} is not formatted: clang-format -i {name}"
    if found.returncode != 0 and not names:
        yield found.stderr.strip()


def check_words(root, files):
    """No sleeping to poll, no paths of one machine, no leftovers of a merge."""
    sleep = re.compile(r"std::this_thread::sleep_(for|until)")
    home = re.compile(r"/(home|Users|root)/\w+/")
    for name in files:
        if not name.endswith(SOURCE_ENDINGS + (".py", ".md", ".cmake", ".txt", ".sh", ".toml")):
            continue
        text = read(root, name)
        if name.endswith(SOURCE_ENDINGS) and not name.startswith("test/") and sleep.search(text):
            yield f"{name} sleeps: wait on a condition variable or a descriptor"
        if home.search(text):
            yield f"{name} names a folder of one machine"
        if re.search(r"^(<<<<<<< |>>>>>>> )", text, re.MULTILINE):
            yield f"{name} holds the marks of a merge conflict"


RULES = {"includes": check_includes, "mirrors": check_mirrors, "sizes": check_sizes, "headers": check_headers, "format": check_format,
         "words": check_words}


def main(arguments):
    if not arguments or arguments[0] not in RULES:
        sys.exit(__doc__)
    root = arguments[1] if len(arguments) > 1 else os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
    files = tracked_files(root)
    if not any(name.endswith(SOURCE_ENDINGS) for name in files):
        sys.exit(f"no sources under {root}: wrong folder?")
    violations = list(RULES[arguments[0]](root, files))
    for line in violations:
        print(line)
    print(f"{arguments[0]}: {len(violations)} violations")
    return 1 if violations else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
