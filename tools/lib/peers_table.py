# SPDX-FileCopyrightText: 2026 The edgesplat authors
# SPDX-License-Identifier: Apache-2.0
"""Ours and other programs' odometry on the same scans, one core each, in one table: peers_table.py EDGESPLAT OUT SHARED_DATA ROUNDS

Run by the Python that has the peers. Each program runs alone, all of them in turn, ROUNDS times over; a time is the least of the runs'
means, of processor time. The errors: on simulated recordings against the truth; on KITTI's drives, which have none here, against a
reference made from the scans as they were fired (kitti_reference.py), and against KISS-ICP's and GICP's trajectories that come with
the drives and take each scan as of one moment.
"""
import bisect
import json
import os
import pathlib
import subprocess
import sys

import numpy as np

import kitti_reference
import livox_recording

DRIVES = {"0005": "kitti_drive0005_80scans", "0052": "kitti_drive0052_78scans_images"}
WORLDS = ("corridor", "street")
OURS = {"lo": "ours, LiDAR", "lio": "ours, LiDAR and IMU", "livo": "ours, with camera"}
PEERS = ("kiss-icp", "genz-icp", "small-gicp")
PEERS_WITH_IMU = ("rko-lio",)
WORST_DRIVE_M = 0.05
HERE = pathlib.Path(__file__).resolve().parent


def unpack_drive(shared, name, out):
    """The scans of a drive as .bin files; None where they are not there."""
    source, folder = shared / name, out / name
    if not source.is_dir():
        return None
    if not folder.is_dir():
        sys.path.insert(0, str(shared))
        import lidar_pack
        partial = out / (name + ".partial")
        partial.mkdir(parents=True, exist_ok=True)
        for file in sorted((source / "velodyne").glob("*.mmx")):
            lidar_pack.unpack(file.read_bytes()).tofile(partial / (file.stem + ".bin"))
        partial.rename(folder)
    return folder


def simulate(edgesplat, world, out):
    recording = out / f"{world}.mcap"
    if not recording.exists():
        partial = out / "partial.mcap"
        subprocess.run([edgesplat, "simulate", "--world", world, "--seconds", "25", "--camera", "320x256", "--out", partial],
                       check=True, stdout=subprocess.DEVNULL)
        partial.rename(recording)
    return recording


def reference_of_drive(folder):
    """The reference's poses as KITTI writes them, made once."""
    path = folder.with_suffix(".reference.txt")
    if not path.exists():
        scans = [np.fromfile(file, np.float32).reshape(-1, 4)[:, :3].astype(float) for file in sorted(folder.glob("*.bin"))]
        np.savetxt(path, [pose[:3].ravel() for pose in kitti_reference.reference_poses(scans)], fmt="%.9g")
    return path


def run_json(command, **options):
    """What a program prints as JSON; some of the peers' libraries print statistics beside it."""
    lines = subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True, **options).stdout.splitlines()
    return json.loads(next(line for line in reversed(lines) if line.startswith("{\"")))


def run_ours(edgesplat, mode, scans, trajectory):
    last_core = sorted(os.sched_getaffinity(0))[-1]
    run = run_json([edgesplat, "odometry", "--lidar", scans, "--timing", "auto", "--mode", mode, "--out", trajectory, "--json"],
                   preexec_fn=lambda: os.sched_setaffinity(0, {last_core}))
    return run["track_cpu_ms"]


def run_peer(name, scans, trajectory):
    return run_json([sys.executable, HERE / "odometry_peer.py", name, scans, trajectory])["cpu_ms"]


def read_tum(path):
    return [tuple(map(float, line.split())) for line in path.read_text().splitlines() if line.strip() and line[0] != "#"]


def truth_at(truth, stamps):
    """Rows of the truth between its samples, 5 ms apart: there straight lines do."""
    times = [row[0] for row in truth]
    for stamp in stamps:
        i = min(max(bisect.bisect(times, stamp), 1), len(times) - 1)
        before, after = truth[i - 1], truth[i]
        share = (stamp - before[0]) / (after[0] - before[0])
        sign = 1.0 if sum(a * b for a, b in zip(before[4:], after[4:])) > 0.0 else -1.0
        row = [b + share * (a - b) for b, a in zip(before[1:4], after[1:4])]
        quaternion = [b + share * (sign * a - b) for b, a in zip(before[4:], after[4:])]
        norm = sum(q * q for q in quaternion) ** 0.5
        yield (stamp, *row, *(q / norm for q in quaternion))


def write_tum(path, rows):
    path.write_text("".join(f"{row[0]:.9f} " + " ".join(f"{value:.9g}" for value in row[1:]) + "\n" for row in rows))


def ate_m(edgesplat, trajectory, reference, options=()):
    run = run_json([edgesplat, "evaluate", "--estimate", trajectory, "--reference", reference, *options, "--json"])
    return run["ate_m"]["rmse"]


def errors(edgesplat, shared, scans, trajectory):
    """{what it is compared with: ATE in metres}"""
    if scans.is_dir():
        folder = shared / scans.name
        options = ("--reference-format", "kitti", "--rate", "10")
        return {"reference": ate_m(edgesplat, trajectory, reference_of_drive(scans), options),
                "KISS-ICP": ate_m(edgesplat, trajectory, folder / "poses_kiss_icp_pseudo.txt", options),
                "GICP": ate_m(edgesplat, trajectory, folder / "poses_velo_gicp_pseudo.txt", options)}
    truth = livox_recording.read_truth(scans)
    stamps = [row[0] for row in read_tum(trajectory) if truth[0][0] <= row[0] <= truth[-1][0]]
    reference = trajectory.with_suffix(".truth.tum")
    write_tum(reference, truth_at(truth, stamps))
    return {"truth": ate_m(edgesplat, trajectory, reference, ("--max-diff", "0.001"))}


def measure(edgesplat, shared, out, scans, rounds):
    """{program: {"cpu_ms": ..., "ate_m": {reference: m}}}"""
    programs = {OURS["lo"]: lambda to: run_ours(edgesplat, "lo", scans, to)}
    if not scans.is_dir():
        programs |= {OURS[mode]: lambda to, mode=mode: run_ours(edgesplat, mode, scans, to) for mode in ("lio", "livo")}
    peers = PEERS if scans.is_dir() else PEERS + PEERS_WITH_IMU
    programs |= {peer: lambda to, peer=peer: run_peer(peer, scans, to) for peer in peers}
    results = {}
    for _ in range(rounds):
        for name, run in programs.items():
            trajectory = out / f"{scans.stem}_{name.replace(', ', '_').replace(' ', '_')}.tum"
            cpu_ms = run(trajectory)
            best = results.setdefault(name, {"cpu_ms": cpu_ms, "ate_m": errors(edgesplat, shared, scans, trajectory)})
            if cpu_ms["mean"] < best["cpu_ms"]["mean"]:
                best["cpu_ms"] = cpu_ms
    return results


def main():
    edgesplat, out, shared = sys.argv[1], pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3])
    out.mkdir(parents=True, exist_ok=True)
    jobs = [folder for name in DRIVES.values() if (folder := unpack_drive(shared, name, out))]
    jobs += [simulate(edgesplat, world, out) for world in WORLDS]
    table, missed = {}, []
    print(f"{'scans':<32}{'program':<24}{'CPU ms a scan':>14}{'p95':>8}   ATE, m")
    for scans in jobs:
        results = table[scans.stem] = measure(edgesplat, shared, out, scans, int(sys.argv[4]))
        for name, run in results.items():
            against = ", ".join(f"{error:.4f} ({reference})" for reference, error in run["ate_m"].items())
            print(f"{scans.stem:<32}{name:<24}{run['cpu_ms']['mean']:>14.1f}{run['cpu_ms']['p95']:>8.1f}   {against}", flush=True)
        for mode, peers in (("lo", PEERS), ("lio", PEERS_WITH_IMU)):
            times_ms = [results[peer]["cpu_ms"]["mean"] for peer in peers if peer in results]
            if times_ms and 2.0 * results[OURS[mode]]["cpu_ms"]["mean"] > min(times_ms):
                missed.append(f"{scans.stem}, {OURS[mode]}: more than half of the fastest peer's processor time")
        if scans.is_dir():
            error_m = {name: run["ate_m"]["reference"] for name, run in results.items()}
            if error_m[OURS["lo"]] > WORST_DRIVE_M:
                missed.append(f"{scans.stem}: more than {WORST_DRIVE_M} m off the reference")
        else:
            error_m = {name: run["ate_m"]["truth"] for name, run in results.items()}
            if error_m[OURS["lo"]] > min(error_m[peer] for peer in PEERS):
                missed.append(f"{scans.stem}: a peer without IMU is closer to the truth")
            if error_m[OURS["lio"]] > min(error_m[peer] for peer in PEERS_WITH_IMU):
                missed.append(f"{scans.stem}: a peer with IMU is closer to the truth")
    (out / "peers.json").write_text(json.dumps(table, indent=1))
    for line in missed:
        print("missed: " + line)
    sys.exit(1 if missed else 0)


if __name__ == "__main__":
    main()
