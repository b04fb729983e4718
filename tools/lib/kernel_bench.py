# SPDX-FileCopyrightText: 2026 The edgesplat authors
# SPDX-License-Identifier: Apache-2.0
"""Runs edgesplat-bench benchmark by benchmark, each in a process of its own so that its peak memory is known.

kernel_bench.py table BENCH [--simd LEVEL]...     times, what there was to do, and times by the calibration loop
kernel_bench.py scale BENCH CSV [--plot FILE]     how time and memory grow
"""
import argparse
import csv
import json
import os
import subprocess
import sys
import tempfile

TABLE = ("forward_cpu", "project_cpu", "tiles_cpu", "colour_loss_cpu", "step_cpu")


def names(bench, pattern):
    listed = subprocess.run([bench, "--benchmark_list_tests", f"--benchmark_filter={pattern}"], check=True,
                            capture_output=True, text=True)
    return listed.stdout.split()


def run(bench, name, seconds, simd=None):
    """One benchmark: Google Benchmark's record, with the process's peak memory as peak_mb."""
    with tempfile.NamedTemporaryFile(suffix=".json") as out:
        command = [bench, f"--benchmark_filter=^{name}$", f"--benchmark_min_time={seconds}",
                   f"--benchmark_out={out.name}", "--benchmark_out_format=json"]
        if simd:
            command += ["--simd", simd]
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        _, status, usage = os.wait4(process.pid, 0)
        if status != 0:
            raise SystemExit(f"{' '.join(command)} failed: run it alone to see why")
        record = json.load(open(out.name, encoding="utf-8"))["benchmarks"][0]
    record["peak_mb"] = usage.ru_maxrss * 1024 / 1e6
    return record


def short(name):
    return name.replace("/process_time", "").replace("/real_time", "")


def table(bench, levels):
    print(f"{'':<52}{'simd':>9}{'wall ms':>9}{'cpu ms':>9}{'by calibration':>16}{'evaluations':>13}{'pairs':>9}{'peak MB':>9}")
    for level in levels:
        for name in names(bench, "|".join(TABLE)):
            try:
                r = run(bench, name, 1.0, level)
            except IndexError:
                continue
            if r.get("error_occurred"):
                print(f"{short(name):<52}{level or '':>9}  skipped: {r['error_message']}")
                continue
            calibration = r.get("calibration_ms")
            print(f"{short(name):<52}{level or 'best':>9}{r['real_time']:>9.2f}{r['cpu_time']:>9.2f}"
                  + (f"{r['real_time'] / calibration:>16.2f}{r['evaluations'] / 1e6:>12.1f}M{r['tile_pairs'] / 1e3:>8.0f}k"
                     if calibration else f"{'':>38}")
                  + f"{r['peak_mb']:>9.0f}", flush=True)


def scale(bench, path, plot):
    rows = []
    everything = names(bench, "scale_")
    for number, name in enumerate(everything):
        print(f"\r{number + 1}/{len(everything)} {short(name):<40}", end="", file=sys.stderr, flush=True)
        r = run(bench, name, 1.0)
        what, gaussians, width, height = short(name).split("/")
        rows.append({"what": what.removeprefix("scale_"), "gaussians": int(gaussians), "width_px": int(width),
                     "height_px": int(height), "tile_pairs": int(r["tile_pairs"]), "wall_ms": round(r["real_time"], 3),
                     "cpu_ms": round(r["cpu_time"], 3), "calibration_ms": round(r["calibration_ms"], 2),
                     "peak_mb": round(r["peak_mb"], 1)})
    print(file=sys.stderr)
    with open(path, "w", newline="", encoding="utf-8") as out:
        writer = csv.DictWriter(out, rows[0].keys())
        writer.writeheader()
        writer.writerows(rows)
    if plot:
        draw(rows, plot)


def draw(rows, path):
    import matplotlib
    matplotlib.use("svg")
    import matplotlib.pyplot as plt
    figure, axes = plt.subplots(1, 3, figsize=(13, 4.2))
    sizes = sorted({(r["width_px"], r["height_px"]) for r in rows})
    for what, marker in (("forward", "o"), ("step", "s")):
        for number, (width, height) in enumerate(sizes):
            line = [r for r in rows if r["what"] == what and r["width_px"] == width and r["height_px"] == height]
            style = {"marker": marker, "color": f"C{number}", "linestyle": "-" if what == "step" else "--",
                     "markersize": 4, "label": f"{what} {width}x{height}"}
            gaussians = [r["gaussians"] for r in line]
            axes[0].plot(gaussians, [r["wall_ms"] for r in line], **style)
            axes[1].plot(gaussians, [1e6 * r["wall_ms"] / r["tile_pairs"] for r in line], **style)
            axes[2].plot(gaussians, [r["peak_mb"] for r in line], **style)
    for axis, label in zip(axes, ("wall, ms", "wall a tile pair, ns", "peak memory of the process, MB")):
        axis.set_xscale("log")
        axis.set_yscale("log")
        axis.set_xlabel("Gaussians")
        axis.set_ylabel(label)
        axis.grid(True, which="both", alpha=0.25)
    axes[0].legend(fontsize=7)
    figure.tight_layout()
    figure.savefig(path, metadata={"Date": None})


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=("table", "scale"))
    parser.add_argument("bench")
    parser.add_argument("csv", nargs="?")
    parser.add_argument("--simd", action="append", default=[])
    parser.add_argument("--plot")
    arguments = parser.parse_args()
    if arguments.what == "table":
        table(arguments.bench, arguments.simd or [None])
    else:
        scale(arguments.bench, arguments.csv, arguments.plot)


main()
