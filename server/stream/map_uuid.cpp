// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "server/stream/map_uuid.hpp"

#include <random>

namespace edgesplat::stream {

map::MapUuid make_map_uuid() {
  map::MapUuid uuid;
  std::random_device source;
  for (std::byte& b : uuid.bytes) b = static_cast<std::byte>(source() & 0xFFU);
  uuid.bytes[6] = (uuid.bytes[6] & std::byte{0x0F}) | std::byte{0x40};  // version 4, RFC 9562 section 5.4
  uuid.bytes[8] = (uuid.bytes[8] & std::byte{0x3F}) | std::byte{0x80};  // variant
  return uuid;
}

}  // namespace edgesplat::stream
