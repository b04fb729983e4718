# SPDX-FileCopyrightText: 2026 The edgesplat authors
# SPDX-License-Identifier: Apache-2.0
"""Scans, IMU samples and truth of a recording with a Livox LiDAR (SDK2), for programs that are not ours. Needs numpy and mcap."""
import struct

import numpy as np
from mcap.reader import make_reader

GRAVITY_MPS2 = 9.80665
HEADER_BYTES = 36
POINT = np.dtype([("p_mm", "<i4", 3), ("reflectivity", "u1"), ("tag", "u1")])


def payload(message):
    """The bytes of a CDR message that holds one uint8[]."""
    (count,) = struct.unpack_from("<I", message, 4)
    return message[8:8 + count]


def packets(path, topic):
    with open(path, "rb") as file:
        for _, _, message in make_reader(file).iter_messages(topics=[topic]):
            datagram = payload(message.data)
            interval_100ns, count = struct.unpack_from("<HH", datagram, 3)
            (stamp_ns,) = struct.unpack_from("<Q", datagram, 28)
            yield stamp_ns, interval_100ns * 100, count, datagram[10], datagram[HEADER_BYTES:]


def read_scans(path, span_s=0.1):
    """[(end_ns, points [N,3] m in the LiDAR's frame, times [N] ns)], cut every span_s."""
    points, times = [], []
    for stamp_ns, interval_ns, count, kind, data in packets(path, "/lidar/points_raw"):
        assert kind == 1, "32-bit Cartesian points"
        points.append(np.frombuffer(data, POINT, count)["p_mm"] / 1000.0)
        times.append(stamp_ns + np.arange(count) * interval_ns // max(1, count - 1))
    points, times = np.concatenate(points), np.concatenate(times)
    seen = np.any(points != 0.0, axis=1)
    points, times = points[seen], times[seen]
    span_ns = int(span_s * 1e9)
    scan = (times - times[0]) // span_ns
    cuts = np.flatnonzero(np.diff(scan)) + 1
    return [(int(t[-1]), p, t) for p, t in zip(np.split(points, cuts), np.split(times, cuts))]


def read_imu(path):
    """[(time_ns, acceleration m/s^2, rate rad/s)]"""
    samples = []
    for stamp_ns, _, _, kind, data in packets(path, "/lidar/imu_raw"):
        assert kind == 0, "IMU samples"
        values = np.frombuffer(data, "<f4", 6).astype(float)
        samples.append((stamp_ns, values[3:] * GRAVITY_MPS2, values[:3]))
    return samples


def read_truth(path):
    """Rows of TUM: t x y z qx qy qz qw"""
    rows = []
    with open(path, "rb") as file:
        for _, _, message in make_reader(file).iter_messages(topics=["/truth/body_pose"]):
            seconds, nanoseconds, frame_length = struct.unpack_from("<iII", message.data, 4)
            at = 16 + frame_length
            at = 4 + (at - 4 + 7) // 8 * 8
            rows.append((seconds + nanoseconds * 1e-9, *struct.unpack_from("<7d", message.data, at)))
    return rows
