// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/drivers/replay/scan_file.hpp"

#include "common/base/bytes.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace edgesplat::replay {

Status check_scan_size(std::uintmax_t bytes, std::string_view file_name) {
  if (bytes == 0 || bytes % kScanPointBytes != 0)
    return fail(Errc::kCorrupt,
                std::string(file_name) + " has " + std::to_string(bytes) +
                    " bytes; a scan is float32 x, y, z, intensity: a multiple of 16. Copy the "
                    "file again or remove it");
  if (bytes > kMaxScanFileBytes)
    return fail(Errc::kCorrupt, std::string(file_name) + " has " + std::to_string(bytes) +
                                    " bytes; scans of up to " + std::to_string(kMaxScanFileBytes) +
                                    " are read");
  return {};
}

Result<std::vector<sensor::LidarPoint>> parse_scan(std::span<const std::byte> bytes,
                                                   std::string_view file_name, std::uint64_t& dropped) {
  EDGESPLAT_TRY_STATUS(check_scan_size(bytes.size(), file_name));
  std::vector<sensor::LidarPoint> points;
  points.reserve(bytes.size() / kScanPointBytes);
  ByteReader reader(bytes);
  while (reader.remaining() > 0) {
    const float x = reader.read<float>();
    const float y = reader.read<float>();
    const float z = reader.read<float>();
    const float intensity = reader.read<float>();
    const bool is_return =
        std::isfinite(x) && std::isfinite(y) && std::isfinite(z) && (x != 0.0F || y != 0.0F || z != 0.0F);
    if (!is_return) {
      ++dropped;
      continue;
    }
    sensor::LidarPoint& point = points.emplace_back();
    point.p_in_lidar_m = {x, y, z};
    point.reflectivity = std::isfinite(intensity) ? std::clamp(intensity, 0.0F, 1.0F) : 0.0F;
  }
  return points;
}

}  // namespace edgesplat::replay
