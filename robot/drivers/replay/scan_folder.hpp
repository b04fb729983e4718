// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "robot/drivers/replay/replay_source.hpp"

#include <filesystem>
#include <memory>

namespace edgesplat::replay {

/// Opens a folder of scans: the layout of KITTI raw (velodyne/*.bin, and with image_02/*.{jpg,png} also
/// calib_*.txt), or `.bin` files directly in the folder; times.txt optional (see FrameTimes). No IMU; body =
/// LiDAR. Arrival = stamp, counted from the first scan's time or as times.txt says.
[[nodiscard]] Result<std::unique_ptr<ReplaySource::Reader>> open_scan_folder(
    const std::filesystem::path& folder);

/// It holds .bin scans, itself or in velodyne/.
[[nodiscard]] bool holds_scans(const std::filesystem::path& folder);

}  // namespace edgesplat::replay
