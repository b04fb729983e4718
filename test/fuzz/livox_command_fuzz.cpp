// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/drivers/livox/checksum.hpp"
#include "robot/drivers/livox/livox_command.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

/// One command frame as it is, and again with its length and checksums made right, so that the lists are
/// reached.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace edgesplat::livox;
  std::vector<std::byte> datagram(size);
  std::copy_n(std::as_bytes(std::span(bytes, size)).begin(), size, datagram.begin());
  const auto feed = [&] {
    const auto frame = decode_command(datagram);
    if (!frame) return;
    (void)decode_discovery_ack(*frame);
    (void)decode_parameter_reply(*frame);
    (void)decode_state_push(*frame);
  };
  feed();
  if (size < kCommandHeaderBytes) return 0;
  const auto length = static_cast<std::uint16_t>(size);
  std::memcpy(datagram.data() + 2, &length, sizeof(length));
  const std::uint16_t header_crc = crc16(std::span(datagram).first(18));
  std::memcpy(datagram.data() + 18, &header_crc, sizeof(header_crc));
  const std::uint32_t content_crc = crc32(std::span(datagram).subspan(kCommandHeaderBytes));
  std::memcpy(datagram.data() + 20, &content_crc, sizeof(content_crc));
  feed();
  return 0;
}
