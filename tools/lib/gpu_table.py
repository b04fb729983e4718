#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The edgesplat authors
# SPDX-License-Identifier: Apache-2.0
"""The figures of tools/gpu-check as a table.  usage: gpu_table.py FOLDER      (bench.jsonl, where there: gsplat.jsonl, ncu-0.csv)"""
import csv
import json
import os
import sys

COLUMNS = (("Gaussians", "resident", "{}"), ("picture", None, ""), ("SH", "sh_degree", "{}"), ("visible", "visible", "{}"),
           ("pairs", "tile_pairs", "{}"), ("forward ms", "forward_ms", "{:.3f}"), ("fp16 ms", "forward_half_ms", "{:.3f}"),
           ("limit ms", "limit_ms", "{:.3f}"),
           ("forward/limit", "forward_by_limit", "{:.1f}"), ("MB", "frame_bytes", "{}"), ("iteration ms", "iteration_ms", "{:.3f}"),
           ("in order ms", "iteration_ordered_ms", "{:.3f}"), ("peak MiB", "iteration_peak_mib", "{:.0f}"))


def read_lines(file):
    if not os.path.exists(file):
        return []
    with open(file, encoding="utf-8") as lines:
        return [json.loads(line) for line in lines if line.startswith("{")]


def cell(scene, column):
    _, key, form = column
    if key is None:
        return f"{scene['width_px']}x{scene['height_px']}"
    if key not in scene:
        return "-"
    value = scene[key]
    return f"{value / 1e6:.0f}" if key == "frame_bytes" else form.format(value)


def instructions_of_frame(file):
    """Warp instructions of all launches of a run, by kernel, over its frames: ncu's CSV has a line a launch."""
    if not os.path.exists(file):
        return {}
    sums = {}
    with open(file, encoding="utf-8") as lines:
        rows = csv.DictReader(line for line in lines if line.startswith('"'))
        for row in rows:
            if row.get("Metric Name") == "smsp__inst_executed.sum":
                name = row["Kernel Name"].split("(")[0]
                count, total = sums.get(name, (0, 0.0))
                sums[name] = (count + 1, total + float(row["Metric Value"].replace(",", "")))
    return {name: total / count for name, (count, total) in sums.items()}


def main(arguments):
    if len(arguments) != 1:
        sys.exit(__doc__)
    lines = read_lines(os.path.join(arguments[0], "bench.jsonl"))
    scenes = [line for line in lines if "resident" in line]
    if not scenes:
        print("no figures")
        return 1
    for line in lines:
        if "device" in line:
            print(f"{line['device']}: copies {line['copy_gb_per_s']:.0f} GB/s; medians of {line['rounds']}")
    print("| " + " | ".join(column[0] for column in COLUMNS) + " |")
    print("|" + "---|" * len(COLUMNS))
    for scene in scenes:
        print("| " + " | ".join(cell(scene, column) for column in COLUMNS) + " |")
    for line in read_lines(os.path.join(arguments[0], "gsplat.jsonl")):
        print(f"gsplat on the scene of {line['resident']} Gaussians, SH {line['sh_degree']}: forward {line['forward_ms']:.3f} ms, iteration "
              f"{line['iteration_ms']:.3f} ms ({line['ssim']}); its picture against ours: {line['psnr_db']:.1f} dB")
        for ours in scenes:
            if (ours["resident"], ours["visible"], ours["sh_degree"]) == (line["resident"], line["visible"], line["sh_degree"]):
                print(f"  gsplat over edgesplat: forward {line['forward_ms'] / ours['forward_ms']:.2f}, iteration "
                      f"{line['iteration_ms'] / ours['iteration_ms']:.2f}")
    instructions = instructions_of_frame(os.path.join(arguments[0], "ncu-0.csv"))
    for name, count in sorted(instructions.items(), key=lambda item: -item[1]):
        print(f"{count / 1e6:9.2f} M warp instructions a launch of {name}")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
