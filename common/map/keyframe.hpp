// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/strong_id.hpp"
#include "common/sensor/rig.hpp"
#include "common/time/time.hpp"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace edgesplat::map {

/// Number of a keyframe, counted up by the robot that made it.
using KeyframeId = StrongId<struct KeyframeTag, std::uint32_t>;

struct ColouredPoint {
  Eigen::Vector3f p_in_body_m;      ///< in the body frame at the keyframe's stamp
  std::array<std::uint8_t, 3> rgb;  ///< sRGB; meaningful only where has_colour
  bool has_colour = false;          ///< seen by the camera at this or a neighbouring keyframe
};

/// A compressed picture as the camera or the encoder made it.
struct EncodedImage {
  enum class Format : std::uint8_t { kJpeg = 1, kPng = 2 };
  Format format = Format::kJpeg;
  int width_px = 0;
  int height_px = 0;
  std::vector<std::byte> bytes;
};

/// What the robot tells the map about one moment. Goes up to the server; spooled on the robot. `pose_version`
/// counts corrections of this keyframe's pose (0 = as tracked).
struct Keyframe {
  KeyframeId id;
  HostTime stamp{};
  geometry::RigidTransform odom_from_body;
  Eigen::Matrix<double, 6, 6> pose_covariance =
      Eigen::Matrix<double, 6, 6>::Zero();  ///< rotation, translation
  std::uint32_t pose_version = 0;
  float exposure_s =
      0.0F;  ///< that `image` and the colours are scaled to, one for the whole map; 0 = unknown
  std::optional<sensor::CameraMount> camera;  ///< absent with a LiDAR-only rig
  std::shared_ptr<const EncodedImage> image;  ///< null without a camera; taken at `stamp`
  std::vector<ColouredPoint> points_in_body;
};

}  // namespace edgesplat::map
