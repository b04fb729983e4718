// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/base/check.hpp"
#include "common/io/splat_gaussians.hpp"

#include <cstddef>
#include <cstdint>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* first, std::size_t size) {
  using namespace edgesplat::io;
  if (const auto cloud = parse_gaussians_splat(std::as_bytes(std::span(first, size)))) {
    EDGESPLAT_CHECK(cloud->consistent(), "array lengths must agree");
  }
  return 0;
}
