#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The edgesplat authors
# SPDX-License-Identifier: Apache-2.0
"""Compares `edgesplat evaluate` with evo on random trajectories.  usage: evo_peer_test.py EDGESPLAT"""
import copy
import json
import subprocess
import sys
import tempfile

try:
    import numpy as np
    from evo.core import metrics, sync
    from evo.core.units import Unit
    from evo.tools import file_interface
except ImportError as error:
    print(f"skipped: evo is not installed ({error}); tools/setup --peers installs it")
    sys.exit(77)

TOLERANCE = 1e-6


def random_trajectory(generator, count):
    """[stamp, x y z, qx qy qz qw] along a curve."""
    stamps = 1.7e9 + np.arange(count) * 0.1 + generator.uniform(-0.002, 0.002, count)
    angle = np.linspace(0, 5, count)
    positions = np.c_[30 * np.sin(angle), 20 * np.cos(angle), angle] + generator.normal(0, 0.02, (count, 3))
    quaternions = np.c_[generator.normal(0, 0.02, (count, 2)), np.sin(angle / 2), np.cos(angle / 2)]
    quaternions /= np.linalg.norm(quaternions, axis=1, keepdims=True)
    return np.c_[stamps, positions, quaternions]


def evo_results(estimate_path, reference_path):
    reference = file_interface.read_tum_trajectory_file(reference_path)
    estimate = file_interface.read_tum_trajectory_file(estimate_path)
    reference, estimate = sync.associate_trajectories(reference, estimate, max_diff=0.01)
    aligned = copy.deepcopy(estimate)
    aligned.align(reference, correct_scale=False)
    ape = metrics.APE(metrics.PoseRelation.translation_part)
    ape.process_data((reference, aligned))
    results = {("ate_m",): ape.get_all_statistics()}
    for key, unit in (("rpe_per_frame", Unit.frames), ("rpe_per_metre", Unit.meters)):
        for part, relation in (("translation_m", metrics.PoseRelation.translation_part),
                               ("rotation_deg", metrics.PoseRelation.rotation_angle_deg)):
            rpe = metrics.RPE(relation, 1.0, unit, all_pairs=False, pairs_from_reference=True)
            rpe.process_data((reference, estimate))
            results[(key, part)] = rpe.get_all_statistics()
    return results, reference.num_poses


def main(edgesplat):
    worst = 0.0
    for seed in range(5):
        generator = np.random.default_rng(seed)
        reference = random_trajectory(generator, 400 + 37 * seed)
        estimate = reference[generator.random(len(reference)) > 0.1].copy()
        estimate[:, 0] += generator.uniform(-0.004, 0.004, len(estimate))
        estimate[:, 1:4] = estimate[:, 1:4] @ np.array([[0, 1, 0], [-1, 0, 0], [0, 0, 1]]) + 3
        estimate[:, 1:4] += np.cumsum(generator.normal(0, 0.005, (len(estimate), 3)), axis=0)
        with tempfile.TemporaryDirectory() as folder:
            paths = [f"{folder}/estimate.tum", f"{folder}/reference.tum"]
            for path, rows in zip(paths, (estimate, reference)):
                np.savetxt(path, rows, fmt="%.9f")
            ours = json.loads(subprocess.check_output(
                [edgesplat, "evaluate", "--json", "--estimate", paths[0], "--reference", paths[1]]))
            theirs, pairs = evo_results(*paths)
        assert ours["pairs"] == pairs, (ours["pairs"], pairs)
        for keys, statistics in theirs.items():
            mine = ours
            for key in keys:
                mine = mine[key]
            for name, key in (("rmse", "rmse"), ("mean", "mean"), ("median", "median"), ("std", "stddev"),
                              ("min", "min"), ("max", "max")):
                difference = abs(mine[key] - statistics[name])
                worst = max(worst, difference)
                assert difference < TOLERANCE, (seed, keys, name, mine[key], statistics[name])
    print(f"5 trajectories agree with evo; largest difference {worst:.2e}")


if __name__ == "__main__":
    main(sys.argv[1])
