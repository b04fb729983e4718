// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/drivers/livox/checksum.hpp"
#include "robot/drivers/livox/livox_source.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

/// One datagram as it is, and again with its length and checksum made right, so that the records are reached.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace edgesplat;
  std::vector<std::byte> datagram(size);
  std::copy_n(std::as_bytes(std::span(bytes, size)).begin(), size, datagram.begin());
  livox::LivoxSource source;
  const auto feed = [&] {
    (void)source.on_points(datagram, host_time_from_ns(1));
    (void)source.on_imu(datagram, host_time_from_ns(2));
  };
  feed();
  if (size < livox::kPacketHeaderBytes) return 0;
  const auto length = static_cast<std::uint16_t>(size);
  std::memcpy(datagram.data() + 1, &length, sizeof(length));
  const std::uint32_t crc = livox::crc32(std::span(datagram).subspan(28));
  std::memcpy(datagram.data() + 24, &crc, sizeof(crc));
  feed();
  return 0;
}
