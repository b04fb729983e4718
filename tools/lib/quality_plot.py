# SPDX-FileCopyrightText: 2026 The edgesplat authors
# SPDX-License-Identifier: Apache-2.0
"""Draws held-out quality over training time: quality_plot.py OUT.svg SCENE:LABEL=CURVE.csv...
Curves are what `edgesplat train --curve` writes; curves of one scene share a column, PSNR above, LPIPS (SSIM without it) below."""
import csv
import sys

COLUMNS = ["seconds", "iterations", "gaussians", "psnr_db", "ssim", "lpips"]


def read_curve(path):
    """Columns of numbers by name; lpips is empty where a line has none. ValueError says what is wrong with the file."""
    with open(path, newline="", encoding="utf-8") as file:
        rows = csv.DictReader(file)
        if rows.fieldnames != COLUMNS:
            raise ValueError(f"{path} is no curve of `edgesplat train --curve`: its columns are {rows.fieldnames}")
        lines = list(rows)
    if not lines:
        raise ValueError(f"{path} has no line yet")
    curve = {name: [float(line[name]) for line in lines] for name in COLUMNS[:-1]}
    curve["lpips"] = [float(line["lpips"]) for line in lines] if all(line["lpips"] for line in lines) else []
    if any(a >= b for a, b in zip(curve["seconds"], curve["seconds"][1:])):
        raise ValueError(f"{path}: time does not go on")
    return curve


def parse_argument(argument):
    """SCENE, LABEL and PATH of SCENE:LABEL=PATH."""
    name, equals, path = argument.partition("=")
    scene, colon, label = name.partition(":")
    if not (equals and colon and scene and label and path):
        raise ValueError(f"'{argument}' is not of the form SCENE:LABEL=CURVE.csv")
    return scene, label, path


def draw(curves, out):
    """`curves`: scene -> label -> curve."""
    import matplotlib
    matplotlib.use("Agg")
    matplotlib.rcParams["svg.hashsalt"] = "edgesplat"  # the same curves give the same file
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(2, len(curves), figsize=(4.6 * len(curves), 5.6), squeeze=False, sharex="col")
    with_lpips = all(curve["lpips"] for scene in curves.values() for curve in scene.values())
    for column, (scene, labelled) in enumerate(curves.items()):
        for row, (key, words) in enumerate([("psnr_db", "PSNR, dB"), ("lpips", "LPIPS") if with_lpips else ("ssim", "SSIM")]):
            axis = axes[row][column]
            for label, curve in labelled.items():
                axis.plot(curve["seconds"], curve[key], marker=".", label=label)
            axis.set_xscale("log")
            axis.grid(alpha=0.3)
            axis.set_ylabel(words)
        axes[0][column].set_title(scene)
        axes[0][column].legend(fontsize="small")
        axes[1][column].set_xlabel("seconds of training")
    figure.tight_layout()
    figure.savefig(out, metadata={"Date": None} if str(out).endswith(".svg") else None)


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    curves = {}
    try:
        for scene, label, path in map(parse_argument, sys.argv[2:]):
            curves.setdefault(scene, {})[label] = read_curve(path)
    except (OSError, ValueError) as error:
        sys.exit(str(error))
    draw(curves, sys.argv[1])


if __name__ == "__main__":
    main()
