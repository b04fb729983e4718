// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/link/ack.hpp"

#include "common/base/bytes.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace edgesplat::link {
namespace {

constexpr std::uint32_t kMagic = 0x31414345U;  // "ECA1"
constexpr std::uint16_t kVersion = 2;
constexpr std::size_t kMaxReport_bytes = 4096;

void write_lane(ByteWriter& out, const Ack& ack) {
  out.write(static_cast<std::uint8_t>(ack.lane));
  out.write(ack.next_train);
  out.write(ack.received_bits);
  out.write(ack.received_total);
  out.write(ack.newest_train);
  out.write(ack.newest_chunk);
  out.write(ack.newest_attempt);
  out.write(ack.newest_came_ns);
  const std::size_t parts = std::min(ack.partial.size(), kMaxPartialTrains);
  out.write(static_cast<std::uint8_t>(parts));
  for (std::size_t i = 0; i < parts; ++i) {
    out.write(ack.partial[i].train);
    out.write(ack.partial[i].first_missing);
    out.write(ack.partial[i].came_bits);
  }
}

/// False where the lane or the number of parts makes no sense.
bool read_lane(ByteReader& in, Ack& ack) {
  const auto lane = in.read<std::uint8_t>();
  ack.lane = static_cast<Lane>(lane);
  ack.next_train = in.read<std::uint32_t>();
  ack.received_bits = in.read<std::uint64_t>();
  ack.received_total = in.read<std::uint64_t>();
  ack.newest_train = in.read<std::uint32_t>();
  ack.newest_chunk = in.read<std::uint32_t>();
  ack.newest_attempt = in.read<std::uint32_t>();
  ack.newest_came_ns = in.read<std::int64_t>();
  const auto parts = in.read<std::uint8_t>();
  if (!in.ok() || lane >= kLaneCount || parts > kMaxPartialTrains) return false;
  for (std::uint8_t i = 0; i < parts; ++i) {
    PartialTrain part;
    part.train = in.read<std::uint32_t>();
    part.first_missing = in.read<std::uint32_t>();
    part.came_bits = in.read<std::uint64_t>();
    ack.partial.push_back(part);
  }
  return in.ok();
}

}  // namespace

std::vector<std::byte> encode_acks(const AckReport& report) {
  ByteWriter out;
  out.write(kMagic);
  out.write(kVersion);
  out.write(report.session);
  out.write(report.delivered_bytes);
  out.write(report.sent_ns);
  out.write(static_cast<std::uint8_t>(report.lanes.size()));
  for (const Ack& ack : report.lanes) write_lane(out, ack);
  return out.take();
}

Result<AckReport> decode_acks(std::span<const std::byte> bytes) {
  if (bytes.size() > kMaxReport_bytes) return fail(Errc::kCorrupt, "an acknowledgement is too long");
  ByteReader in(bytes);
  if (in.read<std::uint32_t>() != kMagic || in.read<std::uint16_t>() != kVersion) {
    return fail(Errc::kCorrupt, "not an acknowledgement of a version this program reads");
  }
  AckReport report;
  report.session = in.read<std::uint64_t>();
  report.delivered_bytes = in.read<std::uint64_t>();
  report.sent_ns = in.read<std::int64_t>();
  const auto count = in.read<std::uint8_t>();
  std::array<bool, kLaneCount> seen{};
  for (std::uint8_t i = 0; i < count; ++i) {
    Ack ack;
    if (!read_lane(in, ack) || std::exchange(seen[index_of(ack.lane)], true)) {
      return fail(Errc::kCorrupt, "an acknowledgement's lanes make no sense");
    }
    report.lanes.push_back(std::move(ack));
  }
  if (!in.ok() || in.remaining() != 0) return fail(Errc::kCorrupt, "an acknowledgement has the wrong length");
  return report;
}

}  // namespace edgesplat::link
