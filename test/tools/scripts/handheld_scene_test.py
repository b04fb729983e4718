# SPDX-FileCopyrightText: 2026 The edgesplat authors
# SPDX-License-Identifier: Apache-2.0
"""handheld_scene_test.py FOLDER: tests the handheld_scene.py of that folder; exit code 77 without numpy and Pillow."""
import importlib.util
import pathlib
import sys
import unittest

FOLDER = pathlib.Path(sys.argv.pop(1))
sys.path.insert(0, str(FOLDER))
if not all(map(importlib.util.find_spec, ("numpy", "PIL"))):
    print("skipped: no numpy or no Pillow")
    sys.exit(77)
import numpy as np  # noqa: E402
import handheld_scene  # noqa: E402  pylint: disable=wrong-import-position

CAMERA = handheld_scene.Camera({"w": 320, "h": 240, "fl_x": 160.0, "cx": 160.7, "cy": 119.6, "k1": -0.06, "k2": 0.01, "p1": 4e-4, "p2": -3e-4})


def rotation_of(q):
    """Of a quaternion x, y, z, w."""
    x, y, z, w = q
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                     [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                     [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])


class HandheldScene(unittest.TestCase):
    def test_rays_are_where_pixels_are(self):
        pixels = np.array([[0.0, 0.0], [319.0, 239.0], [160.2, 119.1], [30.5, 200.0]])
        np.testing.assert_allclose(CAMERA.project(CAMERA.rays(pixels)), pixels, atol=1e-6)

    def test_quaternions_are_those_of_their_rotations(self):
        for vector in ([0.3, -0.2, 0.9], [3.1, 0.1, 0.0], [0, 0, 0], [-1.5, 2.0, 0.5]):
            turn = handheld_scene.turn(np.array(vector, float))
            np.testing.assert_allclose(rotation_of(handheld_scene.quaternion_xyzw(turn)), turn, atol=1e-9)

    def test_the_body_carries_its_camera_along_the_walk(self):
        poses = [handheld_scene.walk(i) for i in (0, 17, 59)]
        for line, pose in zip(handheld_scene.body_poses(poses).splitlines(), poses):
            values = np.array([float(word) for word in line.split()])
            body = rotation_of(values[4:])
            np.testing.assert_allclose(values[1:4] + body @ [0.09, 0.01, 0.13], pose[:3, 3], atol=1e-6)
            ahead = body @ [np.cos(np.deg2rad(3)), 0, -np.sin(np.deg2rad(3))]  # the camera looks 3 degrees down
            np.testing.assert_allclose(ahead, -pose[:3, 2], atol=1e-6)

    def test_points_lie_on_what_is_within_reach(self):
        picture = np.full((240, 320, 3), 100, np.uint8)
        picture[:120] = 5  # too dark to be measured
        depth_m = np.full((240, 320), 3.0)
        depth_m[:, 160:] = 7.0
        pose = handheld_scene.walk(9)
        points, colours = handheld_scene.measured_points(np.random.default_rng(1), picture, depth_m, pose, CAMERA)
        local = (points - pose[:3, 3]) @ pose[:3, :3]
        self.assertGreater(len(points), 100)
        self.assertEqual(len(points), len(colours))
        self.assertTrue((abs(-local[:, 2] - 3.0) < 0.1).all())
        self.assertGreater(np.std(local[:, 2]), 0.01)
        self.assertTrue((colours == 100).all())

    def test_near_surfaces_hide_far_ones(self):
        pose = np.eye(4)
        grid = np.stack(np.meshgrid(np.linspace(-1, 1, 300), np.linspace(-1, 1, 300)), -1).reshape(-1, 2)
        near = np.column_stack([2 * grid, np.full(len(grid), -2.0)])
        far = np.column_stack([8 * grid, np.full(len(grid), -8.0)])
        depth_m = handheld_scene.depth_picture(np.concatenate([far, near]), pose, CAMERA)
        self.assertAlmostEqual(depth_m.max(), 2.0, places=5)
        self.assertGreater((depth_m > 0).mean(), 0.5)


if __name__ == "__main__":
    unittest.main()
