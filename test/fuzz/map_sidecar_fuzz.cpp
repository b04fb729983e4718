// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/base/check.hpp"
#include "common/io/map_sidecar.hpp"

#include <cstddef>
#include <cstdint>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* first, std::size_t size) {
  using namespace edgesplat::io;
  if (const auto sidecar = parse_sidecar({reinterpret_cast<const char*>(first), size})) {
    EDGESPLAT_CHECK(sidecar->sh_degree >= 0 && sidecar->sh_degree <= 3, "a degree that clouds have");
  }
  return 0;
}
