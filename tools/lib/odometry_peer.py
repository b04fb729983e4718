# SPDX-FileCopyrightText: 2026 The edgesplat authors
# SPDX-License-Identifier: Apache-2.0
"""Runs another program's odometry over scans on one core: odometry_peer.py PROGRAM INPUT OUT.tum

PROGRAM: kiss-icp, genz-icp, small-gicp or rko-lio. INPUT: a folder of KITTI .bin scans or a recording with a Mid-360.
Prints one line of JSON with the processor time of a scan: of registering and mapping it and of what the program has to prepare,
not of reading it or of handing it from Python to C++.
"""
import json
import os
import pathlib
import sys
import time

import numpy as np

import livox_recording

MID360_RANGE_M = 40.0
BODY_FROM_LIDAR = np.eye(4)
BODY_FROM_LIDAR[:3, 3] = (-0.011, -0.02329, 0.04412)  # the simulated Mid-360 and its IMU


class Scan:
    def __init__(self, end_ns, points, times_ns=None):
        self.end_ns, self.points, self.times_ns = end_ns, np.ascontiguousarray(points, dtype=np.float64), times_ns

    def relative_times(self):
        """0 at the scan's begin, 1 at its end; none where its points have no times."""
        if self.times_ns is None:
            return np.array([])
        return (self.times_ns - self.times_ns[0]) / float(self.times_ns[-1] - self.times_ns[0])


def read_scans(path):
    if path.is_dir():
        return [Scan(i * 100_000_000, np.fromfile(file, np.float32).reshape(-1, 4)[:, :3])
                for i, file in enumerate(sorted(path.glob("*.bin")))]
    return [Scan(*scan) for scan in livox_recording.read_scans(path)]


class KissIcp:
    """As kiss_icp.kiss_icp.KissICP, the conversion of the points apart."""

    def __init__(self, path):
        from kiss_icp.config import KISSConfig
        from kiss_icp.kiss_icp import KissICP
        from kiss_icp.pybind import kiss_icp_pybind
        config = KISSConfig()
        config.registration.max_num_threads = 1
        if not path.is_dir():
            config.data.max_range = MID360_RANGE_M  # its voxels are a hundredth of it
        config.mapping.voxel_size = config.data.max_range / 100.0
        config.data.deskew = not path.is_dir()
        self.vector = kiss_icp_pybind._Vector3dVector
        self.program = KissICP(config)

    def prepare(self, scan):
        return self.vector(scan.points), scan.relative_times()

    def register(self, prepared):
        points, times = prepared
        program = self.program
        points = np.asarray(program.preprocessor._preprocessor._preprocess(points, times, program.last_delta))
        program.preprocessor.preprocess = lambda frame, *_: frame
        program.register_frame(points, times)
        return program.last_pose


class GenzIcp:
    def __init__(self, path):
        from genz_icp.config import load_config
        from genz_icp.genz_icp import GenZICP
        from genz_icp.pybind import genz_icp_pybind
        config = load_config(pathlib.Path("kitti" if path.is_dir() else "outdoor" if "street" in path.name else "corridor"))
        config.data.deskew = not path.is_dir()
        self.vector = genz_icp_pybind._Vector3dVector
        self.program = GenZICP(config)._odometry

    def prepare(self, scan):
        return self.vector(scan.points), scan.relative_times()

    def register(self, prepared):
        points, times = prepared
        if len(times) > 0:
            self.program._register_frame(points, times)
        else:
            self.program._register_frame(points)
        return np.asarray(self.program._last_pose())


class SmallGicp:
    """Scan to a map of voxels' Gaussians, as in its odometry benchmark; from where the last two scans point to."""

    def __init__(self, path):
        import small_gicp
        self.library = small_gicp
        self.leaf_m = 0.25 if path.is_dir() else 0.1
        self.map = small_gicp.GaussianVoxelMap(1.0 if path.is_dir() else 0.5)
        self.pose, self.delta, self.empty = np.eye(4), np.eye(4), True

    def prepare(self, scan):
        return scan.points[np.linalg.norm(scan.points, axis=1) > 0.3]

    def register(self, points):
        cloud, _ = self.library.preprocess_points(points, downsampling_resolution=self.leaf_m, num_threads=1)
        if not self.empty:
            result = self.library.align(self.map, cloud, init_T_target_source=self.pose @ self.delta, num_threads=1)
            self.delta = np.linalg.inv(self.pose) @ result.T_target_source
            self.pose = result.T_target_source
        self.map.insert(cloud, self.pose)
        self.empty = False
        return self.pose


class RkoLio:
    """With what its documentation advises for sparse LiDARs and small places; its defaults are for cars."""

    def __init__(self, path):
        from rko_lio.config import LIOConfig
        from rko_lio.lio import LIO
        self.lio = LIO(LIOConfig(max_num_threads=1, min_range=0.3, max_range=MID360_RANGE_M, voxel_size=0.5, double_downsample=False,
                                 initialization_phase=True))
        from rko_lio.rko_lio_pybind import _Vector3sVector, _VectorInt64
        self.types = _Vector3sVector, _VectorInt64
        self.imu = livox_recording.read_imu(path)

    def prepare(self, scan):
        samples = [s for s in self.imu if s[0] <= scan.end_ns]
        self.imu = self.imu[len(samples):]
        return samples, self.types[0](scan.points), self.types[1](scan.times_ns), int(scan.times_ns[0]), scan.end_ns

    def register(self, prepared):
        samples, points, times, begin_ns, end_ns = prepared
        for stamp_ns, acceleration, rate in samples:
            self.lio._impl.add_imu_measurement(acceleration, rate, stamp_ns)
        self.lio._impl.register_scan(BODY_FROM_LIDAR, points, times, begin_ns, end_ns)
        return self.lio.pose()


PROGRAMS = {"kiss-icp": KissIcp, "genz-icp": GenzIcp, "small-gicp": SmallGicp, "rko-lio": RkoLio}


def quaternion_xyzw(rotation):
    """Of a rotation by less than a half turn about some axis: by the largest of the four."""
    m = rotation
    squares = np.array([1 + m[0, 0] - m[1, 1] - m[2, 2], 1 - m[0, 0] + m[1, 1] - m[2, 2],
                        1 - m[0, 0] - m[1, 1] + m[2, 2], 1 + m[0, 0] + m[1, 1] + m[2, 2]])
    columns = ((squares[0], m[1, 0] + m[0, 1], m[0, 2] + m[2, 0], m[2, 1] - m[1, 2]),
               (m[1, 0] + m[0, 1], squares[1], m[2, 1] + m[1, 2], m[0, 2] - m[2, 0]),
               (m[0, 2] + m[2, 0], m[2, 1] + m[1, 2], squares[2], m[1, 0] - m[0, 1]),
               (m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1], squares[3]))
    q = np.array(columns[int(np.argmax(squares))])
    return q / np.linalg.norm(q)


def main():
    name, path, out = sys.argv[1], pathlib.Path(sys.argv[2]), sys.argv[3]
    os.sched_setaffinity(0, {sorted(os.sched_getaffinity(0))[-1]})  # one core: its threads then share one
    scans = read_scans(path)
    program = PROGRAMS[name](path)
    body_from_lidar = np.eye(4) if path.is_dir() or name == "rko-lio" else BODY_FROM_LIDAR
    times_ms, rows = [], []
    for scan in scans:
        prepared = program.prepare(scan)
        begin = time.process_time_ns()
        pose = program.register(prepared)
        times_ms.append((time.process_time_ns() - begin) * 1e-6)
        pose = body_from_lidar @ pose @ np.linalg.inv(body_from_lidar)
        rows.append((scan.end_ns * 1e-9, *pose[:3, 3], *quaternion_xyzw(pose[:3, :3])))
    with open(out, "w", encoding="ascii") as file:
        file.writelines(f"{row[0]:.9f} " + " ".join(f"{value:.9g}" for value in row[1:]) + "\n" for row in rows)
    print(json.dumps({"scans": len(rows), "cpu_ms": {"mean": float(np.mean(times_ms)), "p50": float(np.quantile(times_ms, 0.5)),
                                                     "p95": float(np.quantile(times_ms, 0.95))}}))


if __name__ == "__main__":
    main()
