// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/base/check.hpp"
#include "common/base/crc32c.hpp"
#include "common/map/delta_codec.hpp"
#include "common/map/map_state.hpp"

#include <cstring>

// The length and the CRC32C are put right first: else no mutation would get past them. What decodes must be
// applicable to a map that stays sound, and encode again.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace edgesplat;
  const auto* first = reinterpret_cast<const std::byte*>(data);
  (void)map::decode_delta({first, size});
  std::vector<std::byte> bytes(first, first + size);
  if (bytes.size() < map::kDeltaHeader_bytes) return 0;
  constexpr std::size_t kCrcAt = map::kDeltaHeader_bytes - 4;
  const std::span<const std::byte> all(bytes);
  const auto length = static_cast<std::uint32_t>(bytes.size() - map::kDeltaHeader_bytes);
  std::memcpy(bytes.data() + kCrcAt - 4, &length, sizeof(length));
  const std::uint32_t crc = crc32c(all.subspan(map::kDeltaHeader_bytes), crc32c(all.first(kCrcAt)));
  std::memcpy(bytes.data() + kCrcAt, &crc, sizeof(crc));
  const auto delta = map::decode_delta(bytes);
  if (!delta) return 0;
  if (delta->kind() != map::DeltaKind::kRepose)
    EDGESPLAT_CHECK(map::encode_delta(*delta).has_value(), "what was decoded can be encoded");
  map::MapState state;
  for (int round = 0; round < 2; ++round) (void)state.apply(*delta);
  EDGESPLAT_CHECK(state.rows().consistent(), "a map's arrays agree");
  EDGESPLAT_CHECK(map::dequantise(state.rows()).consistent(), "and its floats");
  return 0;
}
