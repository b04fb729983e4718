// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/drivers/frame_socket/frame_assembler.hpp"
#include "robot/drivers/frame_socket/frame_source.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

/// A byte stream in reads of a size that the first byte gives; then the same with the first header's
/// checksums made right, so that lengths and pictures are reached.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace edgesplat::frame_socket;
  if (size == 0) return 0;
  const std::size_t step = 1 + bytes[0];
  std::vector<std::byte> stream(size - 1);
  std::copy_n(std::as_bytes(std::span(bytes, size)).begin() + 1, size - 1, stream.begin());
  const auto feed = [&] {
    FrameAssembler assembler;
    FrameSource source;
    for (std::size_t at = 0; at < stream.size(); at += step) {
      assembler.append(std::span(stream).subspan(at, std::min(step, stream.size() - at)));
      while (const auto frame = assembler.next()) (void)source.on_frame(*frame, {});
    }
  };
  feed();
  if (stream.size() < kHeaderBytes) return 0;
  std::uint32_t announced = 0;
  std::memcpy(&announced, stream.data() + 8, sizeof(announced));
  const std::size_t payload_bytes = std::min<std::size_t>(announced, stream.size() - kHeaderBytes);
  const std::uint32_t payload_crc = crc32(std::span(stream).subspan(kHeaderBytes, payload_bytes));
  std::memcpy(stream.data() + 40, &payload_crc, sizeof(payload_crc));
  const std::uint32_t header_crc = crc32(std::span(stream).first(44));
  std::memcpy(stream.data() + 44, &header_crc, sizeof(header_crc));
  feed();
  return 0;
}
