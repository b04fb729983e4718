// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/base/check.hpp"
#include "common/base/crc32c.hpp"
#include "common/map/keyframe_codec.hpp"

#include <cstring>

// The CRC32C is put right first: else no mutation would get past it.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace edgesplat;
  const auto* first = reinterpret_cast<const std::byte*>(data);
  (void)map::decode_keyframe({first, size});
  std::vector<std::byte> bytes(first, first + size);
  if (bytes.size() < 16) return 0;
  const std::span<const std::byte> all(bytes);
  const auto length = static_cast<std::uint32_t>(bytes.size() - 16);
  std::memcpy(bytes.data() + 8, &length, sizeof(length));
  const std::uint32_t crc = crc32c(all.subspan(16), crc32c(all.first(12)));
  std::memcpy(bytes.data() + 12, &crc, sizeof(crc));
  const auto keyframe = map::decode_keyframe(bytes);
  if (!keyframe) return 0;
  EDGESPLAT_CHECK(keyframe->odom_from_body.is_finite(), "a decoded pose is finite");
  for (const auto& point : keyframe->points_in_body) {
    EDGESPLAT_CHECK(point.p_in_body_m.allFinite(), "decoded points are finite");
  }
  return 0;
}
