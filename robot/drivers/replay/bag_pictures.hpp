// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/io/ros_sensor_messages.hpp"
#include "common/sensor/image.hpp"

namespace edgesplat::replay {

/// Pictures of ROS messages to colour: mono8, rgb8, bgr8, rgba8, bgra8 and the four bayer_*8 (bilinear), also
/// 8UC1 and 8UC3 (taken as mono8 and bgr8). kCorrupt where it does not fit its size (1..16384 pixels a side)
/// or has another encoding.
[[nodiscard]] Result<sensor::ImageRgb8> picture_of(const io::RosImage& image);
/// JPEG or PNG; a mosaic that was compressed as grey is interpolated.
[[nodiscard]] Result<sensor::ImageRgb8> picture_of(const io::RosCompressedImage& image);

}  // namespace edgesplat::replay
