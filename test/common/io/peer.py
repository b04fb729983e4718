#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The edgesplat authors
# SPDX-License-Identifier: Apache-2.0
"""Reads and writes our file formats with other people's implementations.

usage: peer.py VERB FILE [ARGUMENT]; prints one line an item. Exit code 77: a Python package is missing.
"""
import os
import sys

try:
    import mcap.reader
    import mcap.writer
    import mcap_ros2.decoder
    import numpy
    import PIL.Image
    import plyfile
    import pycolmap
except ImportError as missing:
    print(missing)
    sys.exit(77)


def sample_payload(number):
    return f"message {number}{'.' * (number % 50)}".encode()


def mcap_read(path, reader_name):
    """Every message; reader_name: SeekingReader (uses the summary) or NonSeekingReader (every record)."""
    with open(path, "rb") as stream:
        reader = getattr(mcap.reader, reader_name)(stream, validate_crcs=True)
        for schema, channel, message in reader.iter_messages():
            print(channel.topic, schema.name, channel.message_encoding, message.sequence, message.log_time,
                  message.publish_time, message.data.decode())


def mcap_about(path, _):
    """Summary, attachments and metadata."""
    with open(path, "rb") as stream:
        reader = mcap.reader.SeekingReader(stream, validate_crcs=True)
        statistics = reader.get_summary().statistics
        print(reader.get_header().profile, statistics.message_count, statistics.schema_count,
              statistics.channel_count, statistics.chunk_count > 1, statistics.message_start_time,
              statistics.message_end_time)
        for attachment in reader.iter_attachments():
            print(attachment.name, attachment.media_type, attachment.log_time, attachment.data.decode())
        for metadata in reader.iter_metadata():
            print(metadata.name, sorted(metadata.metadata.items()))


def mcap_write(path, compression):
    """500 messages as mcap_samples.hpp has them, an attachment and metadata."""
    writer = mcap.writer.Writer(path, chunk_size=2000, compression=mcap.writer.CompressionType[compression])
    writer.start(profile="ros2", library="peer")
    schema = writer.register_schema("test/msg/Text", "ros2msg", b"string text\n")
    channels = [writer.register_channel(topic, "cdr", schema, {"side": "left"}) for topic in ("/even", "/odd")]
    for number in range(500):
        writer.add_message(channels[number % 2], number * 10_000_000, sample_payload(number), number, number)
    writer.add_attachment(5, 6, "rig.toml", "application/toml", b"name = 'peer'")
    writer.add_metadata("run", {"robot": "r2"})
    writer.finish()


def ros2_read(path, _):
    """Decodes by the schemas in the file, as viewers do."""
    with open(path, "rb") as stream:
        reader = mcap.reader.make_reader(stream, decoder_factories=[mcap_ros2.decoder.DecoderFactory()])
        for schema, _, _, message in reader.iter_decoded_messages():
            if schema.name.endswith("RawDatagram"):
                print(schema.name, bytes(message.data).hex())
            elif schema.name.endswith("FrameMeta"):
                print(schema.name, message.stamp.sec, message.stamp.nanosec, message.sequence, message.exposure_s,
                      message.gain_db, message.stamp_source)
            elif schema.name.endswith("CompressedImage"):
                stamp = message.header.stamp
                print(schema.name, stamp.sec, stamp.nanosec, message.header.frame_id, message.format,
                      bytes(message.data).hex())
            else:
                pose = message.pose
                print(schema.name, message.header.stamp.sec, message.header.stamp.nanosec, message.header.frame_id,
                      pose.position.x, pose.position.y, pose.position.z, pose.orientation.x, pose.orientation.y,
                      pose.orientation.z, pose.orientation.w)


def ply_read(path, _):
    """Column names and all rows."""
    vertices = plyfile.PlyData.read(path)["vertex"].data
    print(*vertices.dtype.names)
    for row in vertices:
        print(*(f"{float(value):g}" for value in row))


def ply_write(path, form):
    """Three coloured points."""
    rows = [(i, -i, 0.5 * i, 10 * i, 20 * i, 30 * i) for i in range(3)]
    columns = [("x", "f8"), ("y", "f4"), ("z", "f4"), ("red", "u1"), ("green", "u1"), ("blue", "u1")]
    element = plyfile.PlyElement.describe(numpy.array(rows, dtype=columns), "vertex")
    plyfile.PlyData([element], text=form == "ascii", byte_order="<").write(path)


def image_read(path, _):
    """Mode, size and pixels."""
    with PIL.Image.open(path) as image:
        print(image.mode, image.width, image.height, *numpy.asarray(image).reshape(-1))


def image_write(path, mode):
    """A 5 x 3 picture whose values count up, in a Pillow mode (L, I;16, RGB, RGBA, P, LA); prints its RGB values."""
    channels = {"RGB": 3, "RGBA": 4, "LA": 2}.get(mode, 1)
    values = numpy.arange(5 * 3 * channels)
    values = (values * 1000).astype(numpy.uint16) if mode == "I;16" else values.astype(numpy.uint8)
    shape = (3, 5) if channels == 1 else (3, 5, channels)
    image = PIL.Image.fromarray(values.reshape(shape))
    if mode == "P":
        image = image.convert("RGB").convert("P")
    image.save(path)
    print(*numpy.asarray(image.convert("RGB")).reshape(-1))


COLMAP_CAMERAS = {
    "SIMPLE_PINHOLE": [500, 320, 240], "PINHOLE": [500, 510, 320, 240], "SIMPLE_RADIAL": [500, 320, 240, -0.1],
    "RADIAL": [500, 320, 240, -0.1, 0.02], "OPENCV": [500, 510, 321, 242, -0.1, 0.02, 0.003, -0.002],
    "OPENCV_FISHEYE": [300, 310, 320, 240, -0.02, 0.003, -0.001, 0.0002],
    "FULL_OPENCV": [500, 510, 320, 240, -0.1, 0.02, 0.003, -0.002, -0.004, 0, 0, 0],
    "SIMPLE_RADIAL_FISHEYE": [300, 320, 240, -0.02], "RADIAL_FISHEYE": [300, 320, 240, -0.02, 0.003],
    "SIMPLE_FISHEYE": [300, 320, 240], "FISHEYE": [300, 310, 320, 240]}


def colmap_write(path, form):
    """An image with features by each camera, 20 points; prints where each image shows each point: NAME X Y Z U V."""
    random = numpy.random.default_rng(7)
    scene = pycolmap.Reconstruction()
    points = random.uniform(-1, 1, (20, 3)) + [0, 0, 4]
    for point in points:
        scene.add_point3D(point, pycolmap.Track(), random.integers(0, 256, 3).astype(numpy.uint8))
    for number, (model, parameters) in enumerate(COLMAP_CAMERAS.items(), 1):
        scene.add_camera_with_trivial_rig(
            pycolmap.Camera(camera_id=number, model=model, width=640, height=480, params=parameters))
        turn = random.normal(0, 0.15, 4) + [0, 0, 0, 1]
        pose = pycolmap.Rigid3d(pycolmap.Rotation3d(turn / numpy.linalg.norm(turn)), random.normal(0, 0.3, 3))
        features = random.uniform(0, 400, (number % 3, 2))
        image = pycolmap.Image(name=model + ".png", keypoints=features, camera_id=number, image_id=100 - number)
        scene.add_image_with_trivial_frame(image, pose)
    os.makedirs(path)
    (scene.write_text if form == "text" else scene.write_binary)(path)
    for image in scene.images.values():
        for point in points:
            print(image.name, *point, *image.project_point(point))


if __name__ == "__main__":
    globals()[sys.argv[1]](sys.argv[2], sys.argv[3] if len(sys.argv) > 3 else None)
