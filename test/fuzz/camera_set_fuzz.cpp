// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/base/check.hpp"
#include "common/io/camera_set.hpp"

#include <cstddef>
#include <cstdint>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* first, std::size_t size) {
  using namespace edgesplat::io;
  if (const auto set = parse_camera_set({reinterpret_cast<const char*>(first), size})) {
    for (const PosedCamera& camera : set->cameras) {
      EDGESPLAT_CHECK(!camera.name.empty() && camera.map_from_camera.is_finite(), "a name and a pose each");
    }
  }
  return 0;
}
