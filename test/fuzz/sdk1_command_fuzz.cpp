// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/drivers/livox/checksum.hpp"
#include "robot/drivers/livox/sdk1_command.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

/// One SDK1 frame as it is, and again with its length and checksums made right, so that the content is
/// reached.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace edgesplat::livox;
  std::vector<std::byte> datagram(size);
  std::copy_n(std::as_bytes(std::span(bytes, size)).begin(), size, datagram.begin());
  const auto feed = [&] {
    const auto frame = decode_sdk1(datagram);
    if (!frame) return;
    (void)decode_sdk1_announcement(*frame);
    (void)decode_sdk1_heartbeat(*frame);
    (void)decode_sdk1_return_code(*frame);
    (void)decode_sdk1_firmware(*frame);
    if (const auto word = decode_sdk1_status_push(*frame)) (void)read_sdk1_status(*word);
  };
  feed();
  if (size < kSdk1FrameBytes) return 0;
  const auto length = static_cast<std::uint16_t>(size);
  std::memcpy(datagram.data() + 2, &length, sizeof(length));
  const std::uint16_t header_crc = sdk1_crc16(std::span(datagram).first(7));
  std::memcpy(datagram.data() + 7, &header_crc, sizeof(header_crc));
  const std::uint32_t crc = sdk1_crc32(std::span(datagram).first(size - 4));
  std::memcpy(datagram.data() + size - 4, &crc, sizeof(crc));
  feed();
  return 0;
}
