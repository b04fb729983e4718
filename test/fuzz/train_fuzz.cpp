// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/base/bytes.hpp"
#include "common/base/check.hpp"
#include "common/link/flight.hpp"
#include "common/link/heartbeat.hpp"
#include "common/link/receive_side.hpp"

#include <algorithm>

namespace {

/// A report of a hostile peer must not confuse what is on its way to it.
void fuzz_acks(std::span<const std::byte> input) {
  using namespace edgesplat;
  const auto report = link::decode_acks(input);
  if (!report) return;
  link::Flight flight;
  for (std::uint32_t train = 1; train <= 3; ++train) {
    link::ChunkHeader header;
    header.train = train;
    header.total_bytes = static_cast<std::uint32_t>(3 * link::kChunk_bytes);
    header.count = 3;
    flight.begin(header, std::vector<std::byte>(header.total_bytes));
    for (int i = 0; i < 2 && flight.next(HostTime{}, 1U << 24U); ++i) (void)flight.sent(HostTime{});
  }
  for (const link::Ack& ack : report->lanes) (void)flight.on_ack(ack, {}, HostTime{});
  EDGESPLAT_CHECK(flight.bytes_on_the_way() <= flight.held_bytes(), "nothing flies that is not held");
}

}  // namespace

// The input is a list of chunks as a hostile peer might send them: small fields, so that trains meet and
// complete.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace edgesplat;
  const std::span<const std::byte> input(reinterpret_cast<const std::byte*>(data), size);
  fuzz_acks(input);
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
    const std::size_t size =
        in.read<std::uint8_t>() >= 128 ? link::kChunk_bytes : header.total_bytes % link::kChunk_bytes;
    const auto payload = std::span<const std::byte>(filler).first(size);
    header.chunk_crc32c = link::chunk_crc32c(header, payload);
    now += std::chrono::milliseconds(header.index);
    (void)side.add(lane, header, payload, now);
    side.expire(now);
    (void)side.take_due_acks(now);
  }
  for (const auto& lane : side.counters()) {
    EDGESPLAT_CHECK(lane.messages_received <= lane.chunks_received, "no message without a chunk");
  }
  return 0;
}
