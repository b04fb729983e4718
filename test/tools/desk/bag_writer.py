#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The edgesplat authors
# SPDX-License-Identifier: Apache-2.0
"""Writes ROS bags with PyPI's rosbags from measurements that bag_odometry_peer_test.cpp lists.

usage: bag_writer.py MEASUREMENTS FOLDER. Each measurement: kind u8, arrival ns i64, stamp ns i64, bytes u32, content:
0 sweep: points (offset ns u32, x y z f32, reflectivity tag line u8, 1 byte of padding); 1 IMU: gyro and acceleration, six f64;
2 picture: width and height u32, PNG length u32, PNG, rgb8. Exit code 77: a Python package is missing.
"""
import pathlib
import struct
import sys

try:
    import numpy
    from rosbags import rosbag1, rosbag2
    from rosbags.typesys import Stores, get_types_from_msg, get_typestore
except ImportError as missing:
    print(missing)
    sys.exit(77)

POINT = numpy.dtype([("offset", "<u4"), ("x", "<f4"), ("y", "<f4"), ("z", "<f4"), ("reflectivity", "u1"), ("tag", "u1"),
                     ("line", "u1"), ("padding", "u1")])
CUSTOM_POINT = "uint32 offset_time\nfloat32 x\nfloat32 y\nfloat32 z\nuint8 reflectivity\nuint8 tag\nuint8 line\n"
CUSTOM_MESSAGE = ("std_msgs/Header header\nuint64 timebase\nuint32 point_num\nuint8 lidar_id\nuint8[3] rsvd\n"
                  "CustomPoint[] points\n")


def read_measurements(path):
    data = pathlib.Path(path).read_bytes()
    at = 0
    while at < len(data):
        kind, arrival, stamp, length = struct.unpack_from("<BqqI", data, at)
        at += struct.calcsize("<BqqI")
        yield kind, arrival, stamp, data[at:at + length]
        at += length


class Messages:
    """Measurements as messages of one version of ROS."""

    def __init__(self, is_ros1):
        self.is_ros1 = is_ros1
        self.driver = "livox_ros_driver2"
        self.store = get_typestore(Stores.ROS1_NOETIC if is_ros1 else Stores.ROS2_HUMBLE)
        for name, text in (("CustomPoint", CUSTOM_POINT), ("CustomMsg", CUSTOM_MESSAGE)):
            self.store.register(get_types_from_msg(text, f"{self.driver}/msg/{name}"))
        self.types = self.store.types

    def bytes_of(self, message):
        kind = message.__msgtype__
        return bytes(self.store.serialize_ros1(message, kind) if self.is_ros1 else self.store.serialize_cdr(message, kind))

    def header(self, stamp):
        time = self.types["builtin_interfaces/msg/Time"](sec=stamp // 10**9, nanosec=stamp % 10**9)
        header = self.types["std_msgs/msg/Header"]
        return header(seq=1, stamp=time, frame_id="sensor") if self.is_ros1 else header(stamp=time, frame_id="sensor")

    def imu(self, stamp, content):
        gx, gy, gz, ax, ay, az = struct.unpack("<6d", content)
        vector = self.types["geometry_msgs/msg/Vector3"]
        nothing = numpy.zeros(9)
        return self.bytes_of(self.types["sensor_msgs/msg/Imu"](
            self.header(stamp), self.types["geometry_msgs/msg/Quaternion"](0.0, 0.0, 0.0, 1.0), nothing, vector(gx, gy, gz),
            nothing, vector(ax, ay, az), nothing))

    def custom(self, stamp, content):
        point = self.types[f"{self.driver}/msg/CustomPoint"]
        points = [point(*row[:7]) for row in numpy.frombuffer(content, POINT).tolist()]
        return self.bytes_of(self.types[f"{self.driver}/msg/CustomMsg"](
            self.header(stamp), stamp, len(points), 0, numpy.zeros(3, numpy.uint8), points))

    def cloud(self, stamp, content):
        """As ouster_ros lays it out: t in ns; the last points first, since the order must not matter."""
        points = numpy.frombuffer(content, POINT)[::-1]
        layout = numpy.dtype({"names": ["x", "y", "z", "intensity", "t", "ring"],
                              "formats": ["<f4", "<f4", "<f4", "<f4", "<u4", "<u2"], "offsets": [0, 4, 8, 16, 20, 24],
                              "itemsize": 32})
        out = numpy.zeros(len(points), layout)
        for ours, theirs in (("x", "x"), ("y", "y"), ("z", "z"), ("reflectivity", "intensity"), ("offset", "t"), ("line", "ring")):
            out[theirs] = points[ours]
        field = self.types["sensor_msgs/msg/PointField"]
        fields = [field(name, layout.fields[name][1], code, 1)
                  for name, code in (("x", 7), ("y", 7), ("z", 7), ("intensity", 7), ("t", 6), ("ring", 4))]
        return self.bytes_of(self.types["sensor_msgs/msg/PointCloud2"](
            self.header(stamp), 1, len(points), fields, False, 32, 32 * len(points), numpy.frombuffer(out.tobytes(), numpy.uint8),
            True))

    def compressed(self, stamp, content):
        _, _, length = struct.unpack_from("<III", content)
        return self.bytes_of(self.types["sensor_msgs/msg/CompressedImage"](
            self.header(stamp), "rgb8; png compressed rgb8", numpy.frombuffer(content[12:12 + length], numpy.uint8)))

    def image(self, stamp, content):
        width, height, length = struct.unpack_from("<III", content)
        rgb = numpy.frombuffer(content[12 + length:], numpy.uint8).reshape(height, width, 3)
        return self.bytes_of(self.types["sensor_msgs/msg/Image"](
            self.header(stamp), height, width, "bgr8", 0, 3 * width, rgb[:, :, ::-1].reshape(-1).copy()))


def serialise(measurements, messages, lidar, picture):
    """(topic, type, arrival, bytes) in the order of arrival."""
    topics = {0: ("/lidar", f"{messages.driver}/msg/CustomMsg" if lidar == "custom" else "sensor_msgs/msg/PointCloud2", lidar),
              1: ("/imu", "sensor_msgs/msg/Imu", "imu"),
              2: ("/camera", "sensor_msgs/msg/Image" if picture == "image" else "sensor_msgs/msg/CompressedImage", picture)}
    return [(*topics[kind][:2], arrival, getattr(messages, topics[kind][2])(stamp, content))
            for kind, arrival, stamp, content in measurements]


def write(writer, store, rows):
    with writer:
        connections = {}
        for topic, kind, arrival, content in rows:
            if topic not in connections:
                connections[topic] = writer.add_connection(topic, kind, typestore=store)
            writer.write(connections[topic], arrival, content)


def main():
    measurements = list(read_measurements(sys.argv[1]))
    folder = pathlib.Path(sys.argv[2])
    ros1, ros2 = Messages(True), Messages(False)
    custom = serialise(measurements, ros1, "custom", "compressed")
    for name, compression in (("none", None), ("bz2", rosbag1.Writer.CompressionFormat.BZ2), ("lz4", rosbag1.Writer.CompressionFormat.LZ4)):
        writer = rosbag1.Writer(folder / f"custom_{name}.bag")
        if compression is not None:
            writer.set_compression(compression)
        write(writer, ros1.store, custom)
    write(rosbag1.Writer(folder / "cloud.bag"), ros1.store, serialise(measurements, ros1, "cloud", "image"))
    rows = serialise(measurements, ros2, "custom", "image")
    write(rosbag2.Writer(folder / "sqlite", version=9), ros2.store, rows)
    write(rosbag2.Writer(folder / "mcap", version=9, storage_plugin=rosbag2.StoragePlugin.MCAP), ros2.store, rows)
    rows = serialise(measurements, ros2, "cloud", "compressed")
    for name, mode in (("packed", rosbag2.CompressionMode.FILE), ("messages", rosbag2.CompressionMode.MESSAGE)):
        writer = rosbag2.Writer(folder / name, version=9)
        writer.set_compression(mode, rosbag2.CompressionFormat.ZSTD)
        write(writer, ros2.store, rows)


main()
