// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/io/bag_source.hpp"

#include <memory>
#include <span>

namespace edgesplat::io {

/// A ROS 2 bag in SQLite (rosbag2's .db3; tables topics and messages). A file compressed as a whole
/// (.db3.zstd) is unpacked into the system's folder for temporary files while it is read; messages compressed
/// one by one are unpacked as they come. SQLite runs on damaged files too: what it refuses is told in the
/// report. kNotFound, kIo, or kCorrupt where it is no such file.
[[nodiscard]] Result<std::unique_ptr<BagSource>> open_rosbag2_sqlite(const std::filesystem::path& path);
/// From memory that the caller keeps alive.
[[nodiscard]] Result<std::unique_ptr<BagSource>> rosbag2_sqlite_from_bytes(std::span<const std::byte> bytes);

}  // namespace edgesplat::io
