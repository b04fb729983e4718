#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The edgesplat authors
# SPDX-License-Identifier: Apache-2.0
"""Times gsplat on the scene that `gpu_bench --dump FOLDER` left, one JSON object on stdout.  usage: gsplat_race.py FOLDER ROUNDS

An iteration is forward, 0.8 L1 + 0.2 (1 - SSIM), backward and PyTorch's fused Adam over all parameters. SSIM is fused_ssim's where that
is installed, else 11 taps of PyTorch's convolution each way; which one it was is told.
"""
import json
import math
import os
import statistics
import sys
import time

import numpy
import torch
from gsplat import rasterization


def load(folder, scene):
    def read(name, *shape):
        return torch.from_numpy(numpy.fromfile(os.path.join(folder, name + ".f32"), dtype=numpy.float32).reshape(*shape)).cuda()

    count, terms = scene["resident"], (scene["sh_degree"] + 1) ** 2
    quats = read("quats_xyzw", count, 4)[:, [3, 0, 1, 2]]
    return {"means": read("means", count, 3), "log_scales": read("log_scales", count, 3), "quats": quats.contiguous(),
            "logits": read("opacity_logits", count), "sh": read("sh", count, terms, 3)}


def draw(cloud, scene):
    width, height = scene["width_px"], scene["height_px"]
    # Pixel centres: ours lie at whole numbers, gsplat's at halves.
    focal = 0.8 * width
    intrinsics = torch.tensor([[[focal, 0.0, 0.5 * width + 0.5], [0.0, focal, 0.5 * height + 0.5], [0.0, 0.0, 1.0]]], device="cuda")
    pictures, _, info = rasterization(
        cloud["means"], cloud["quats"], torch.exp(cloud["log_scales"]), torch.sigmoid(cloud["logits"]), cloud["sh"],
        torch.eye(4, device="cuda")[None], intrinsics, width, height, near_plane=0.05, eps2d=0.3, sh_degree=scene["sh_degree"], packed=False)
    return pictures[0], info


def similarity():
    try:
        from fused_ssim import fused_ssim
        return "fused_ssim", lambda a, b: fused_ssim(a.permute(2, 0, 1)[None], b.permute(2, 0, 1)[None])
    except ImportError:
        pass
    taps = torch.tensor([math.exp(-(d * d) / (2 * 1.5 * 1.5)) for d in range(-5, 6)], device="cuda")
    taps = taps / taps.sum()

    def blur(x):
        x = torch.nn.functional.conv2d(x, taps.view(1, 1, 1, 11).expand(x.shape[1], 1, 1, 11), padding=(0, 5), groups=x.shape[1])
        return torch.nn.functional.conv2d(x, taps.view(1, 1, 11, 1).expand(x.shape[1], 1, 11, 1), padding=(5, 0), groups=x.shape[1])

    def ssim(a, b):
        a, b = a.permute(2, 0, 1)[None], b.permute(2, 0, 1)[None]
        x, y, xx, yy, xy = blur(torch.cat([a, b, a * a, b * b, a * b], dim=1)).split(3, dim=1)
        value = (2 * x * y + 1e-4) * (2 * (xy - x * y) + 9e-4) / ((x * x + y * y + 1e-4) * (xx - x * x + yy - y * y + 9e-4))
        return value.mean()

    return "convolutions", ssim


def median_ms(rounds, work):
    took = []
    for i in range(rounds + 3):
        torch.cuda.synchronize()
        began = time.perf_counter()
        work()
        torch.cuda.synchronize()
        if i >= 3:
            took.append((time.perf_counter() - began) * 1e3)
    return statistics.median(took)


def main(arguments):
    if len(arguments) != 2:
        sys.exit(__doc__)
    folder, rounds = arguments[0], int(arguments[1])
    with open(os.path.join(folder, "scene.json"), encoding="utf-8") as file:
        scene = [json.loads(line) for line in file if '"resident"' in line][-1]
    cloud = load(folder, scene)
    ours = torch.from_numpy(numpy.fromfile(os.path.join(folder, "picture.f32"), dtype=numpy.float32)).cuda()
    ours = ours.reshape(scene["height_px"], scene["width_px"], 3)
    with torch.no_grad():
        picture, _ = draw(cloud, scene)
        psnr_db = -10.0 * math.log10(max(1e-10, torch.mean((picture.clamp(0, 1) - ours.clamp(0, 1)) ** 2).item()))
        forward_ms = median_ms(rounds, lambda: draw(cloud, scene))
    for value in cloud.values():
        value.requires_grad_(True)
    optimiser = torch.optim.Adam([{"params": [value], "lr": 1e-4} for value in cloud.values()], eps=1e-15, fused=True)
    target = torch.flip(ours, dims=[1])
    name, ssim = similarity()

    def iteration():
        drawn, _ = draw(cloud, scene)
        loss = 0.8 * torch.abs(drawn - target).mean() + 0.2 * (1.0 - ssim(drawn, target))
        loss.backward()
        optimiser.step()
        optimiser.zero_grad(set_to_none=True)

    iteration_ms = median_ms(rounds, iteration)
    print(json.dumps({"resident": scene["resident"], "visible": scene["visible"], "sh_degree": scene["sh_degree"], "forward_ms": forward_ms,
                      "iteration_ms": iteration_ms, "psnr_db": psnr_db, "ssim": name}))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
