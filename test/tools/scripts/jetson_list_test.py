#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The edgesplat authors
# SPDX-License-Identifier: Apache-2.0
"""jetson-libraries.txt names each library that the programs of this build ask for: a new one is noticed without a cross build.

usage: jetson_list_test.py FOLDER PROGRAM...
"""
import os
import re
import sys

sys.path.insert(0, sys.argv[1])
import jetson_libraries  # noqa: E402


def stem(name):
    """Without versions, which are the distribution's, and the machine: libfmt.so.9 -> libfmt.so."""
    return re.sub(r"^(ld-linux)[^.]*|(\.so)\..*$", r"\1\2", name)


def main(folder, programs):
    _, places = jetson_libraries.read_list(os.path.join(folder, "jetson-libraries.txt"))
    listed = {stem(name) for name in places}
    for program in programs:
        needed = re.findall(r"\(NEEDED\).*\[(.*)\]", jetson_libraries.readelf("-d", program))
        unknown = [name for name in needed if stem(name) not in listed]
        print(f"{os.path.basename(program)}: {len(needed)} libraries, of which the list lacks {unknown or 'none'}")
        if unknown or len(needed) < 10:  # fewer: nothing was read, or the build is a static one that proves nothing
            return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], sys.argv[2:]))
