// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/io/bag_source.hpp"

#include <memory>
#include <span>

namespace edgesplat::io {

/// A ROS 1 bag, format 2.0 (http://wiki.ros.org/Bags/Format/2.0), chunks none, bz2 or lz4. A bag that was not
/// closed is read from its chunks. Holds at most about 64 MiB of decompressed chunks (or two chunks, if
/// larger); every length is checked against the file and 256 MiB before memory is taken. kNotFound, kIo, or
/// kCorrupt where it is no such bag.
[[nodiscard]] Result<std::unique_ptr<BagSource>> open_rosbag1(const std::filesystem::path& path);
/// From memory that the caller keeps alive.
[[nodiscard]] Result<std::unique_ptr<BagSource>> rosbag1_from_bytes(std::span<const std::byte> bytes);

}  // namespace edgesplat::io
