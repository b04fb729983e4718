// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/base/check.hpp"
#include "robot/drivers/serial_imu/serial_source.hpp"

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

/// A byte stream in reads of a size that the first byte gives; then the same with the first frame's checksum
/// made right.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace edgesplat;
  using namespace edgesplat::serial_imu;
  if (size == 0) return 0;
  const std::size_t step = 1 + bytes[0];
  const auto all = std::as_bytes(std::span(bytes, size)).subspan(1);
  std::vector<std::byte> stream(all.begin(), all.end());
  const auto feed = [&] {
    FrameDecoder decoder;
    SerialSource source;
    for (std::size_t at = 0; at < stream.size(); at += step) {
      decoder.append(std::span(stream).subspan(at, std::min(step, stream.size() - at)));
      while (const auto frame = decoder.next())
        if (const auto* inertial = std::get_if<InertialFrame>(&*frame)) (void)source.on_frame(*inertial, {});
    }
    EDGESPLAT_CHECK(decoder.counters().bytes_skipped <= stream.size(), "no byte is skipped twice");
  };
  feed();
  if (stream.size() < kHeaderBytes) return 0;
  const std::size_t checked = kHeaderBytes + std::to_integer<std::size_t>(stream[3]);
  if (stream.size() < checked + kChecksumBytes) return 0;
  stream[0] = std::byte{0xA5};
  stream[1] = std::byte{0x5A};
  const std::uint16_t crc = crc16_ccitt(std::span(stream).subspan(2, checked - 2));
  stream[checked] = static_cast<std::byte>(crc & 0xFFU);
  stream[checked + 1] = static_cast<std::byte>(crc >> 8U);
  feed();
  return 0;
}
