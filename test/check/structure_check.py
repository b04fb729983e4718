#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The edgesplat authors
# SPDX-License-Identifier: Apache-2.0
"""Holds the rules of ARCHITECTURE.md and CONTRIBUTING.md that a machine can check.

usage: structure_check.py RULE [ROOT]      RULE: includes, sizes, headers, format, words
Prints one line a violation; exit code 1 where there is one.
"""
import os
import re
import subprocess
import sys

SOURCE_ENDINGS = (".hpp", ".cpp", ".cu", ".cuh")
MAX_LINES = 500
# A folder may include those of a lower level, and itself.
TOP_LEVELS = {"common": 0, "kernels": 1, "robot": 2, "server": 2, "tools": 3, "test": 4}
COMMON_LEVELS = {"base": 0, "time": 1, "log": 1, "config": 1, "thread": 1, "geometry": 1, "metrics": 2, "sensor": 2,
                 "gaussian": 2, "map": 3, "io": 4, "link": 4, "policy": 4}
# Of one level, but a plain foundation for the rest of it.
COMMON_EXCEPTIONS = {("log", "time"), ("config", "time"), ("thread", "time")}


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


def include_violation(source, target):
    """Why `source` must not include `target`, both paths from the root; None where it may."""
    source_parts, target_parts = source.split("/"), target.split("/")
    top, other = source_parts[0], target_parts[0]
    if top not in TOP_LEVELS or other not in TOP_LEVELS or top == "test":
        return None
    if top != other:
        if source.startswith("robot/drivers/") and other != "common":
            return "drivers see common only"
        return None if TOP_LEVELS[other] < TOP_LEVELS[top] else f"{top} must not include {other}"
    if top == "common":
        module, used = source_parts[1], target_parts[1]
        if module == used or (module, used) in COMMON_EXCEPTIONS:
            return None
        if module not in COMMON_LEVELS or used not in COMMON_LEVELS:
            return f"common/{module if module not in COMMON_LEVELS else used} has no level yet: add it to this check"
        return None if COMMON_LEVELS[used] < COMMON_LEVELS[module] else f"common/{module} must not include common/{used}"
    if source.startswith("robot/drivers/") and not target.startswith("robot/drivers/"):
        return "drivers see common only"
    if target_parts[1] == "app":
        return None if source_parts[1] == "app" else "nothing includes an app folder"
    return None


def check_includes(root, files):
    pattern = re.compile(r'^\s*#\s*include\s*"([^"]+)"', re.MULTILINE)
    for name in files:
        if not name.endswith(SOURCE_ENDINGS):
            continue
        for target in pattern.findall(read(root, name)):
            why = include_violation(name, target)
            if why:
                yield f"{name} includes {target}: {why}"


def check_sizes(root, files):
    for name in files:
        if name.endswith(SOURCE_ENDINGS):
            lines = read(root, name).count("\n")
            if lines > MAX_LINES:
                yield f"{name} has {lines} lines, more than {MAX_LINES}: split it"
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
        if name.endswith((".hpp", ".cuh")) and "#pragma once" not in text:
            yield f"{name} lacks #pragma once"


def check_format(root, files):
    sources = [name for name in files if name.endswith(SOURCE_ENDINGS)]
    found = subprocess.run(["clang-format", "--dry-run", *sources], cwd=root, capture_output=True, text=True, check=False)
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


RULES = {"includes": check_includes, "sizes": check_sizes, "headers": check_headers, "format": check_format,
         "words": check_words}


def main(arguments):
    if not arguments or arguments[0] not in RULES:
        sys.exit(__doc__)
    root = arguments[1] if len(arguments) > 1 else os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
    violations = list(RULES[arguments[0]](root, tracked_files(root)))
    for line in violations:
        print(line)
    print(f"{arguments[0]}: {len(violations)} violations")
    return 1 if violations else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
