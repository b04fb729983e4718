#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The edgesplat authors
# SPDX-License-Identifier: Apache-2.0
"""Adds up JUnit files of ctest: failures with their output, skipped tests with their reason, one line of totals.

usage: test_summary.py ALLOWED_SKIPS RESULT.xml...
Exit code 1 where a test failed, where a skipped test is not in ALLOWED_SKIPS, or where nothing ran.
"""
import fnmatch
import os
import re
import sys
import xml.etree.ElementTree as xml_tree


def allowed_skips(path):
    """[(pattern, reason)]; a line is `pattern reason`, # starts a comment."""
    entries = []
    with open(path, encoding="utf-8") as lines:
        for line in lines:
            words = line.split("#", 1)[0].split(None, 1)
            if not words:
                continue
            if len(words) < 2:
                sys.exit(f"{path}: '{words[0]}' lacks the reason why it may be skipped")
            entries.append((words[0], words[1].strip()))
    return entries


def skip_reason(output):
    """The text a test gave to GTEST_SKIP(), or a CTest-style 'skipped: ...' line."""
    found = re.search(r"^\S*:\d+: Skipped\n(.*?)\n+\[  SKIPPED", output, re.MULTILINE | re.DOTALL)
    found = found or re.search(r"^(?:SKIP|skipped):? *(.*)$", output, re.MULTILINE)
    return " ".join(found.group(1).split()) if found else "no reason given"


def read_results(paths):
    """[(suite, name, status, output)], status one of run, fail, skip."""
    results = []
    for path in paths:
        suite = os.path.splitext(os.path.basename(path))[0].removeprefix("tests-")
        for case in xml_tree.parse(path).getroot().iter("testcase"):
            status = {"run": "run", "disabled": "skip", "notrun": "skip"}.get(case.get("status"), "fail")
            # ctest reports a missing test binary as notrun too: only a real skip has run or says so.
            if case.get("status") == "notrun" and case.find("skipped") is not None:
                message = case.find("skipped").get("message", "")
                status = "skip" if message.startswith("SKIP_") else "fail"
            results.append((suite, case.get("name"), status, case.findtext("system-out") or ""))
    return results


def main(arguments):
    if len(arguments) < 2:
        sys.exit(__doc__)
    allowed = allowed_skips(arguments[0])
    results = read_results(arguments[1:])
    counts = {"run": 0, "fail": 0, "skip": 0}
    unexpected = []
    for suite, name, status, output in results:
        counts[status] += 1
        if status == "fail":
            print(f"--- failed: {name} ({suite})")
            print("\n".join(output.strip().splitlines()[-30:]))
        elif status == "skip":
            print(f"skipped: {name} ({suite}): {skip_reason(output)}")
            if not any(fnmatch.fnmatchcase(name, pattern) for pattern, _ in allowed):
                unexpected.append(name)
    for name in unexpected:
        print(f"not allowed to be skipped: {name}. Make it run, or list it with a reason in {arguments[0]}.")
    if not results:
        print("no test ran")
    print(f"{counts['run']} passed, {counts['fail']} failed, {counts['skip']} skipped")
    return 1 if counts["fail"] or unexpected or not results else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
