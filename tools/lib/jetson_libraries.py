#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The edgesplat authors
# SPDX-License-Identifier: Apache-2.0
"""Which libraries aarch64 programs need on a Jetson, and whether every JetPack that is served has them in time.

usage: jetson_libraries.py check SYSROOT PROGRAM...
       jetson_libraries.py bundle SYSROOT DIR PROGRAM...   check, then DIR/bin and DIR/lib, whole or not at all

The list is jetson-libraries.txt beside this file; --list FILE takes another. Exit code 1 where something would not start.
"""
import os
import re
import shutil
import subprocess
import sys

LIBRARY_FOLDERS = ("usr/lib/aarch64-linux-gnu", "usr/lib")
RPATH = "$ORIGIN/../lib"
DEBIAN_RUNPATH = "$ORIGIN/../lib/aarch64-linux-gnu"  # some of its libraries have it; in the bundle a link leads back to lib


class NotRunnable(Exception):
    """What stands in the way, one sentence."""


def read_list(path):
    """({system: {namespace: version}}, {library: device or shipped})"""
    limits, places = {}, {}
    with open(path, encoding="utf-8") as lines:
        for number, line in enumerate(lines, 1):
            words = line.split("#", 1)[0].split()
            if not words:
                continue
            if words[0] == "limit" and len(words) == 4:
                limits.setdefault(words[1], {})[words[2]] = version(words[3])
            elif words[0] in ("device", "shipped") and len(words) == 2:
                if places.setdefault(words[1], words[0]) != words[0]:
                    raise NotRunnable(f"{path}:{number}: {words[1]} is listed as device and as shipped")
            else:
                raise NotRunnable(f"{path}:{number}: neither 'limit SYSTEM NAMESPACE VERSION' nor 'device|shipped NAME'")
    return limits, places


def version(text):
    return tuple(int(part) for part in text.split("."))


def readelf(option, path):
    done = subprocess.run(["readelf", "-W", option, path], capture_output=True, text=True,
                          env={**os.environ, "LC_ALL": "C"}, check=False)
    if done.returncode != 0 or "Error:" in done.stderr:
        raise NotRunnable(f"{path}: not a program or library: {done.stderr.strip()}")
    return done.stdout


class Binary:
    """What one program or library asks of others."""

    def __init__(self, path):
        self.path = path
        header = readelf("-h", path)
        if "AArch64" not in header:
            machine = re.search(r"Machine: *(.*)", header)
            raise NotRunnable(f"{path}: built for {machine.group(1) if machine else 'nothing'}, not for AArch64")
        dynamic = readelf("-d", path)
        self.needed = re.findall(r"\(NEEDED\).*\[(.*)\]", dynamic)
        self.rpath = re.findall(r"\(RPATH\).*\[(.*)\]", dynamic)
        self.runpath = re.findall(r"\(RUNPATH\).*\[(.*)\]", dynamic)
        self.versions = wanted_versions(readelf("-V", path))


def wanted_versions(text):
    """{library: {(namespace, version)}} from the needs section of readelf -V."""
    wanted, library = {}, None
    for line in text[text.find("Version needs section"):].splitlines() if "Version needs section" in text else []:
        file = re.search(r"File: (\S+)", line)
        if file:
            library = file.group(1)
        name = re.search(r"Name: ([A-Z]+)_([0-9][0-9.]*[0-9]|[0-9])\b", line)
        if name and library:
            wanted.setdefault(library, set()).add((name.group(1), version(name.group(2))))
    return wanted


def find_library(sysroot, name):
    for folder in LIBRARY_FOLDERS:
        path = os.path.join(sysroot, folder, name)
        if os.path.exists(path):
            return path
    raise NotRunnable(f"{name} is not in {sysroot}: run tools/sysroot --again")


def closure(sysroot, places, programs):
    """(every Binary that is shipped, programs first; {device library: who asks}); raises where a library is on no list."""
    shipped, device, todo = {}, {}, [Binary(path) for path in programs]
    found = list(todo)
    while todo:
        binary = todo.pop()
        for name in binary.needed:
            place = places.get(name)
            if place is None:
                raise NotRunnable(f"{os.path.basename(binary.path)} needs {name}, which jetson-libraries.txt does not name: "
                                  "say there whether a device has it or it is shipped")
            if place == "device":
                device.setdefault(name, os.path.basename(binary.path))
            elif name not in shipped:
                shipped[name] = Binary(find_library(sysroot, name))
                todo.append(shipped[name])
                found.append(shipped[name])
    return found, device


def too_new(binaries, limits, places):
    """Sentences: who asks a device's library for a symbol version that a system lacks."""
    words = []
    for binary in binaries:
        for library, wanted in sorted(binary.versions.items()):
            if places.get(library) != "device":
                continue
            for system, newest in sorted(limits.items()):
                for namespace, asked in sorted(wanted):
                    if namespace not in newest:
                        words.append(f"{os.path.basename(binary.path)} needs {namespace}_{dotted(asked)} of {library}: "
                                     f"jetson-libraries.txt has no limit of {system} for it")
                    elif asked > newest[namespace]:
                        words.append(f"{os.path.basename(binary.path)} needs {namespace}_{dotted(asked)} of {library}; "
                                     f"{system} has {namespace}_{dotted(newest[namespace])} at most")
    return words


def dotted(parts):
    return ".".join(map(str, parts))


def newest_wanted(binaries, places, namespace):
    asked = [v for b in binaries for library, wanted in b.versions.items() if places.get(library) == "device"
             for name, v in wanted if name == namespace]
    return max(asked, default=())


def check(sysroot, programs, list_path):
    """The binaries to ship; raises NotRunnable."""
    limits, places = read_list(list_path)
    binaries, device = closure(sysroot, places, programs)
    words = too_new(binaries, limits, places)
    for binary in binaries[:len(programs)]:
        # RPATH, unlike RUNPATH, is also where the shipped libraries' own needs are looked for.
        if binary.rpath != [RPATH] or binary.runpath:
            words.append(f"{os.path.basename(binary.path)} has RPATH {binary.rpath} and RUNPATH {binary.runpath}, not RPATH {RPATH} "
                         "alone: configure in a new build folder, an older one keeps its linker flags")
    for binary in binaries[len(programs):]:
        if any(path != DEBIAN_RUNPATH for path in binary.rpath + binary.runpath):
            words.append(f"{os.path.basename(binary.path)} looks for libraries in {binary.rpath + binary.runpath}")
    if words:
        raise NotRunnable("\n".join(words))
    print(f"{len(programs)} programs: {len(binaries) - len(programs)} libraries are shipped, {len(device)} are the device's")
    for namespace in ("GLIBC", "GLIBCXX", "CXXABI", "GCC", "OPENSSL"):
        newest = newest_wanted(binaries, places, namespace)
        if newest:
            served = ", ".join(f"{system} has {dotted(has[namespace])}" for system, has in sorted(limits.items()))
            print(f"{namespace}: {dotted(newest)} is needed; {served}")
    return binaries


def bundle(sysroot, folder, programs, list_path):
    binaries = check(sysroot, programs, list_path)
    part = folder + ".part"
    shutil.rmtree(part, ignore_errors=True)
    for binary in binaries:
        place = os.path.join(part, "bin" if binary.path in programs else "lib")
        os.makedirs(place, exist_ok=True)
        shutil.copy(binary.path, place)  # what a link leads to, under the link's name
    os.makedirs(os.path.join(part, "lib"), exist_ok=True)
    os.symlink(".", os.path.join(part, "lib/aarch64-linux-gnu"))
    shutil.rmtree(folder, ignore_errors=True)
    os.rename(part, folder)
    size = sum(os.path.getsize(binary.path) for binary in binaries)
    print(f"{folder}: {size / 1e6:.0f} MB")


def main(arguments):
    list_path = os.path.join(os.path.dirname(os.path.abspath(__file__)), "jetson-libraries.txt")
    if arguments[:1] == ["--list"] and len(arguments) > 1:
        list_path, arguments = arguments[1], arguments[2:]
    try:
        if len(arguments) > 2 and arguments[0] == "check":
            check(arguments[1], arguments[2:], list_path)
        elif len(arguments) > 3 and arguments[0] == "bundle":
            bundle(arguments[1], arguments[2].rstrip("/"), arguments[3:], list_path)
        else:
            print(__doc__, file=sys.stderr)
            return 2
    except NotRunnable as problem:
        print(problem, file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
