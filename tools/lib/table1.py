# SPDX-FileCopyrightText: 2026 The edgesplat authors
# SPDX-License-Identifier: Apache-2.0
"""Prints Table I of the edgesplat paper from two run folders: table1.py ROBOT_ALONE WITH_SERVER"""
import json
import pathlib
import sys


def optimising_ms(metrics, prefix):
    """Milliseconds that this program spent on seeding and optimising, all in all."""
    histograms = [metrics.get("histograms", {}).get(f"{prefix}.{name}") for name in ("keyframe_ms", "step_ms")]
    return sum(h["mean"] * h["count"] for h in histograms if h and h["count"])


def row(name, folder):
    folder = pathlib.Path(folder)
    summary = json.loads((folder / "summary.json").read_text())
    robot = json.loads((folder / "robot/metrics.json").read_text())
    server = json.loads((folder / "server/metrics.json").read_text())
    keyframes = summary["keyframes"]
    return [name,
            f"{summary['render_fps_p50']:.0f}",
            f"{summary['render_ms_p95']:.1f}",
            f"{summary['robot_peak_rss_mb']:.0f}",
            f"{optimising_ms(robot, 'local') / keyframes:.0f}",
            f"{optimising_ms(server, 'map') / keyframes:.0f}",
            f"{summary['gaussians']:.0f}",
            "-" if summary.get("psnr_db") is None else f"{summary['psnr_db']:.1f}"]


def main():
    head = ["", "pictures a second, median", "picture, ms p95", "robot's memory, MB",
            "optimising on the robot, ms a keyframe", "on the server, ms a keyframe", "Gaussians drawn",
            "PSNR between keyframes, dB"]
    rows = [head, row("robot alone", sys.argv[1]), row("robot and server", sys.argv[2])]
    print()
    for line, *columns in zip(*rows):
        print(f"  {line:<40}" + "".join(f"{column:>18}" for column in columns))


if __name__ == "__main__":
    main()
