// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/drivers/replay/scan_file.hpp"

#include <cmath>
#include <cstdint>
#include <cstdlib>

/// The bytes of a `.bin` scan: every point that comes out is finite and accounted for.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace edgesplat;
  std::uint64_t dropped = 0;
  const auto points = replay::parse_scan(std::as_bytes(std::span(bytes, size)), "fuzz.bin", dropped);
  if (!points) return 0;
  for (const sensor::LidarPoint& point : *points)
    if (!point.p_in_lidar_m.allFinite() || !(point.reflectivity >= 0.0F && point.reflectivity <= 1.0F))
      std::abort();
  if (points->size() + dropped != size / replay::kScanPointBytes) std::abort();
  return 0;
}
