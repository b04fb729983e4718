// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/base/check.hpp"
#include "common/base/crc32c.hpp"
#include "common/map/map_request.hpp"

#include <algorithm>
#include <cstring>
#include <vector>

// The CRC32C is put right first: else no mutation would get past it.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace edgesplat;
  const auto* first = reinterpret_cast<const std::byte*>(data);
  (void)map::decode_map_request({first, size});
  std::vector<std::byte> bytes(first, first + size);
  if (bytes.size() < 4) return 0;
  const std::uint32_t crc = crc32c(std::span<const std::byte>(bytes).first(bytes.size() - 4));
  std::memcpy(bytes.data() + bytes.size() - 4, &crc, sizeof(crc));
  const auto request = map::decode_map_request(bytes);
  if (!request) return 0;
  EDGESPLAT_CHECK(std::ranges::equal(map::encode_map_request(*request), bytes),
                  "what was decoded encodes to the same bytes");
  return 0;
}
