// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/base/check.hpp"
#include "common/io/trajectory_file.hpp"

#include <cstddef>
#include <cstdint>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* first, std::size_t size) {
  using namespace edgesplat::io;
  const std::string_view text(reinterpret_cast<const char*>(first), size);
  if (const auto poses = parse_tum(text, "fuzz")) {
    for (const auto& pose : *poses) {
      EDGESPLAT_CHECK(pose.world_from_body.is_finite(), "poses must be finite");
      const auto again = parse_decimal_seconds(format_decimal_seconds(pose.stamp));
      EDGESPLAT_CHECK(again == pose.stamp, "times must survive printing");
    }
  }
  if (const auto poses = parse_kitti(text, "fuzz")) {
    for (const auto& pose : *poses) EDGESPLAT_CHECK(pose.is_finite(), "poses must be finite");
  }
  (void)parse_decimal_seconds(text);
  return 0;
}
