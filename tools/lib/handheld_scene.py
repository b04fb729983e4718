# SPDX-FileCopyrightText: 2026 The edgesplat authors
# SPDX-License-Identifier: Apache-2.0
"""A scene as a hand-held RGB-D camera would leave it: handheld_scene.py EDGESPLAT DRIVE OUT
DRIVE is a corridor of `edgesplat convert` (seed 3); its depth pictures tell where surfaces are. 60 pictures of a walk of 2 m with the
camera swung from side to side: exposure and white balance drift (5 % a picture), blur of some pixels, noise, JPEG; poses off by
0.5 cm and 0.25 degrees, drifting; 20 000 points of the pictures that are not held out (every eighth), with noise that grows with the
square of the depth, none beyond 5 m, on dark things and at edges. Needs numpy and Pillow (the environment of tools/setup --peers)."""
import json
import pathlib
import subprocess
import sys

import numpy as np
from PIL import Image

PICTURES, POINTS, HELD_OUT_EVERY = 60, 20000, 8
REACH_M, DARK = 5.0, 28
BODY_FROM_CAMERA_M = np.array([0.09, 0.01, 0.13])  # as tools/simulate mounts its camera, 3 degrees down
PITCH_RAD = np.deg2rad(3.0)


def turn(vector):
    """The rotation by the vector's length around it."""
    angle = np.linalg.norm(vector)
    if angle < 1e-12:
        return np.eye(3)
    x, y, z = vector / angle
    k = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * k + (1 - np.cos(angle)) * k @ k


def quaternion_xyzw(r):
    values, vectors = np.linalg.eigh(np.array([
        [r[0, 0] - r[1, 1] - r[2, 2], 0, 0, 0],
        [r[1, 0] + r[0, 1], r[1, 1] - r[0, 0] - r[2, 2], 0, 0],
        [r[2, 0] + r[0, 2], r[2, 1] + r[1, 2], r[2, 2] - r[0, 0] - r[1, 1], 0],
        [r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1], np.trace(r)]]))
    return vectors[:, np.argmax(values)]


class Camera:
    def __init__(self, file):
        self.size = file["w"], file["h"]
        self.focal_px = file["fl_x"]
        self.centre = np.array([file["cx"] - 0.5, file["cy"] - 0.5])
        self.distortion = [file[name] for name in ("k1", "k2", "p1", "p2")]

    def project(self, rays):
        """Pixels of rays [N,2] (x / z, y / z)."""
        k1, k2, p1, p2 = self.distortion
        x, y = rays.T
        r2 = x * x + y * y
        grow = 1 + k1 * r2 + k2 * r2 * r2
        return self.focal_px * np.stack([x * grow + 2 * p1 * x * y + p2 * (r2 + 2 * x * x),
                                         y * grow + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y], -1) + self.centre

    def rays(self, pixels):
        wanted = (pixels - self.centre) / self.focal_px
        out = wanted.copy()
        for _ in range(20):
            out += wanted - (self.project(out) - self.centre) / self.focal_px
        return out


def walk(i):
    """World_from_camera of picture i in OpenGL's axes, as transforms.json has it."""
    s = i / (PICTURES - 1)
    yaw = np.deg2rad(-75 + 75 * (1 - np.cos(2 * np.pi * s)) + 12 * np.sin(9 * s))
    pitch, roll = np.deg2rad(-6 + 10 * np.sin(11 * s)), np.deg2rad(4 * np.sin(17 * s))
    ahead = np.array([np.cos(yaw) * np.cos(pitch), np.sin(yaw) * np.cos(pitch), np.sin(pitch)])
    right = np.cross(ahead, [0, 0, 1])
    right /= np.linalg.norm(right)
    up = np.cross(right, ahead)
    out = np.eye(4)
    out[:3, 0] = np.cos(roll) * right + np.sin(roll) * up
    out[:3, 1] = np.cos(roll) * up - np.sin(roll) * right
    out[:3, 2] = -ahead
    out[:3, 3] = [6.5 + 2.2 * s + 0.25 * np.sin(13 * s), 0.35 * np.sin(5 * s), 0.95 + 0.15 * np.sin(8 * s)]
    return out


def body_poses(poses):
    """The poses of the simulated robot's body for these of its camera, as lines of a TUM file."""
    c, s = np.cos(PITCH_RAD), np.sin(PITCH_RAD)
    body_from_camera = np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]]) @ np.array([[0, 0, 1], [-1, 0, 0], [0, -1, 0.0]])
    lines = []
    for i, pose in enumerate(poses):
        rotation = pose[:3, :3] * [1, -1, -1] @ body_from_camera.T
        position = pose[:3, 3] - rotation @ BODY_FROM_CAMERA_M
        lines.append(" ".join(f"{value:.9f}" for value in [i / 10, *position, *quaternion_xyzw(rotation)]))
    return "\n".join(lines) + "\n"


def surface_points(drive, file, camera):
    width, height = camera.size
    pixels = np.stack(np.meshgrid(np.arange(width), np.arange(height)), -1).reshape(-1, 2).astype(float)
    rays = camera.rays(pixels)
    out = []
    for frame in file["frames"]:
        depth_m = np.asarray(Image.open(drive / frame["depth_file_path"])).astype(float).ravel() / 1000
        seen = (depth_m > 0) & (depth_m < 12)
        in_camera = np.stack([rays[:, 0] * depth_m, -rays[:, 1] * depth_m, -depth_m], -1)[seen]
        pose = np.array(frame["transform_matrix"])
        out.append((in_camera @ pose[:3, :3].T + pose[:3, 3]).astype(np.float32))
    return np.concatenate(out)


def depth_picture(points, pose, camera):
    """The nearest points of each pixel, without those that shine through gaps of nearer ones; 0 where there is none."""
    width, height = camera.size
    local = (points - pose[:3, 3]) @ pose[:3, :3]
    local = local[local[:, 2] < -0.2]
    depth_m = -local[:, 2]
    rays = np.stack([local[:, 0] / depth_m, -local[:, 1] / depth_m], -1)
    near_axis = (np.abs(rays) < 1.3).all(-1)  # the distortion is a polynomial: it folds back far outside
    depth_m, pixels = depth_m[near_axis], np.rint(camera.project(rays[near_axis])).astype(int)
    inside = ((pixels >= 0) & (pixels < camera.size)).all(-1)
    picture = np.full((height, width), np.inf)
    np.minimum.at(picture, (pixels[inside, 1], pixels[inside, 0]), depth_m[inside])
    nearest = picture.copy()
    for y in range(-3, 4):
        for x in range(-3, 4):
            nearest = np.minimum(nearest, np.roll(picture, (y, x), (0, 1)))
    return np.where(picture <= 1.1 * nearest, np.where(np.isinf(picture), 0, picture), 0)


def drift(random, count, keep, sigma):
    out = np.zeros((count, 3))
    for i in range(1, count):
        out[i] = keep * out[i - 1] + random.normal(0, sigma, 3)
    return out


def spoiled(random, picture, gain):
    """What the sensor makes of a clean picture."""
    dx, dy = random.normal(0, 1.2, 2)
    steps = np.linspace(-0.5, 0.5, max(1, int(np.ceil(np.hypot(dx, dy)))) + 1)
    blurred = np.mean([np.roll(picture, (round(s * dy), round(s * dx)), (0, 1)) for s in steps], 0) / 255
    exposed = np.clip(blurred**2.2 * gain, 0, 1) ** (1 / 2.2)
    return (255 * np.clip(exposed + random.normal(0, 0.012, exposed.shape), 0, 1) + 0.5).astype(np.uint8)


def measured_points(random, picture, depth_m, pose, camera):
    width, height = camera.size
    count = 3 * POINTS // (PICTURES - PICTURES // HELD_OUT_EVERY)
    x, y = random.integers(2, width - 2, count), random.integers(2, height - 2, count)
    z = depth_m[y, x]
    edge = abs(depth_m[y + 2, x] - depth_m[y - 2, x]) + abs(depth_m[y, x + 2] - depth_m[y, x - 2])
    good = (z > 0) & (z < REACH_M) & (picture[y, x].mean(-1) > DARK) & (edge < 0.15 * np.maximum(z, 0.5))
    x, y, z = x[good], y[good], z[good]
    z = z + random.normal(0, 1, len(z)) * (0.003 + 0.0015 * z * z)
    rays = camera.rays(np.stack([x, y], -1).astype(float))
    in_camera = np.stack([rays[:, 0] * z, -rays[:, 1] * z, -z], -1)
    return in_camera @ pose[:3, :3].T + pose[:3, 3], picture[y, x]


def write_points(path, points, colours):
    rows = np.empty(len(points), [("p", "<f4", 3), ("c", "u1", 3)])
    rows["p"], rows["c"] = points, colours
    names = "".join(f"property float {axis}\n" for axis in "xyz") + "".join(f"property uchar {c}\n" for c in ("red", "green", "blue"))
    head = f"ply\nformat binary_little_endian 1.0\nelement vertex {len(points)}\n{names}end_header\n"
    path.write_bytes(head.encode() + rows.tobytes())


def main():
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    edgesplat, drive, out = sys.argv[1], pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3])
    random = np.random.default_rng(7)
    file = json.loads((drive / "transforms.json").read_text())
    camera = Camera(file)
    poses = [walk(i) for i in range(PICTURES)]
    (out / "images").mkdir(parents=True, exist_ok=True)
    (out / "walk.tum").write_text(body_poses(poses))
    subprocess.run([edgesplat, "simulate", "--world", "corridor", "--seed", "3", "--camera", f"{file['w']}x{file['h']}",
                    "--clean-views", out / "walk.tum", "--clean-out", out / "clean"], check=True)
    surfaces = surface_points(drive, file, camera)
    gains = np.exp(drift(random, PICTURES, 0.9, 0.05)[:, :1]) * np.exp(drift(random, PICTURES, 0.9, 0.01))
    shifts, turns = drift(random, PICTURES, 0.8, 0.6 * 0.005 / 3**0.5), drift(random, PICTURES, 0.8, 0.6 * np.deg2rad(0.25) / 3**0.5)
    frames, points, colours = [], [], []
    for i, pose in enumerate(poses):
        clean = np.asarray(Image.open(out / "clean" / f"{i:06}.png").convert("RGB")).astype(float)
        picture = spoiled(random, clean, gains[i])
        name = f"images/{i:06}.jpg"
        Image.fromarray(picture).save(out / name, quality=93)
        claimed = pose.copy()
        claimed[:3, 3] += shifts[i]
        claimed[:3, :3] = claimed[:3, :3] @ turn(turns[i])
        frames.append({"file_path": name, "transform_matrix": claimed.tolist()})
        if i % HELD_OUT_EVERY == 0:
            continue
        measured, seen = measured_points(random, picture, depth_picture(surfaces, pose, camera), claimed, camera)
        points.append(measured)
        colours.append(seen)
    points, colours = np.concatenate(points), np.concatenate(colours)
    kept = random.permutation(len(points))[:POINTS]
    write_points(out / "points.ply", points[kept], colours[kept])
    (out / "transforms.json").write_text(json.dumps({**file, "frames": frames}, indent=1) + "\n")
    print(f"{out}: {PICTURES} pictures, {len(kept)} points")


if __name__ == "__main__":
    main()
