// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/base/check.hpp"
#include "common/io/ply_gaussians.hpp"
#include "common/io/ply_points.hpp"

#include <cstddef>
#include <cstdint>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* first, std::size_t size) {
  using namespace edgesplat::io;
  const auto bytes = std::as_bytes(std::span(first, size));
  if (const auto cloud = parse_gaussians_ply(bytes)) {
    EDGESPLAT_CHECK(cloud->consistent(), "array lengths must agree");
  }
  if (const auto cloud = parse_points_ply(bytes)) {
    EDGESPLAT_CHECK(cloud->rgb.empty() || cloud->rgb.size() == cloud->points_m.size(), "a colour a point");
  }
  return 0;
}
