// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/base/bytes.hpp"
#include "common/base/check.hpp"
#include "common/link/heartbeat.hpp"
#include "common/link/receive_side.hpp"

#include <algorithm>

// The input is a list of chunks as a hostile peer might send them: small fields, so that trains meet and
// complete.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace edgesplat;
  const std::span<const std::byte> input(reinterpret_cast<const std::byte*>(data), size);
  (void)link::decode_ack(input);
  (void)link::decode_heartbeat(input);
  link::ReceiveLimits limits;
  limits.senders = 4;
  limits.assembler = {4, 1U << 20U, std::chrono::seconds(1)};
  link::ReceiveSide side(limits);
  ByteReader in(input);
  HostTime now{};
  const std::vector<std::byte> filler(link::kChunk_bytes);
  while (in.remaining() >= 12) {
    link::ChunkHeader header;
    const auto lane = static_cast<link::Lane>(in.read<std::uint8_t>() % link::kLaneCount);
    header.robot.value = in.read<std::uint8_t>() % 3;
    header.session = in.read<std::uint8_t>() % 8;
    header.train = in.read<std::uint8_t>();
    header.index = in.read<std::uint8_t>();
    header.count = in.read<std::uint8_t>();
    header.total_bytes = in.read<std::uint32_t>();
    header.message_crc32c = in.read<std::uint8_t>();
    const std::size_t payload =
        in.read<std::uint8_t>() >= 128 ? link::kChunk_bytes : header.total_bytes % link::kChunk_bytes;
    now += std::chrono::milliseconds(header.index);
    (void)side.add(lane, header, std::span<const std::byte>(filler).first(payload), now);
    side.expire(now);
    (void)side.take_due_acks();
  }
  for (const auto& lane : side.counters()) {
    EDGESPLAT_CHECK(lane.messages_received <= lane.chunks_received, "no message without a chunk");
  }
  return 0;
}
