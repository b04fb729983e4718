// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/link/heartbeat.hpp"

#include "common/base/bytes.hpp"

#include <cmath>
#include <string>

namespace edgesplat::link {
namespace {

constexpr std::uint32_t kMagic = 0x31424845U;  // "EHB1"
constexpr std::uint16_t kVersion = 1;
constexpr std::size_t kHeartbeat_bytes = 4 + 2 + 1 + 4 + 8 + 8 + 4 + 8 + 4 + 8 + 4;

}  // namespace

std::vector<std::byte> encode_heartbeat(const Heartbeat& heartbeat) {
  ByteWriter out;
  out.write(kMagic);
  out.write(kVersion);
  out.write(static_cast<std::uint8_t>(heartbeat.mode));
  out.write(heartbeat.epoch.value);
  out.write(heartbeat.seq);
  out.write(heartbeat.map_hash);
  out.write(heartbeat.queued_messages);
  out.write(heartbeat.queued_bytes);
  out.write(heartbeat.render_p95_ms);
  out.write(heartbeat.memory_bytes);
  out.write(heartbeat.goodput_bytes_per_s);
  return out.take();
}

Result<Heartbeat> decode_heartbeat(std::span<const std::byte> bytes) {
  ByteReader in(bytes);
  if (in.read<std::uint32_t>() != kMagic) return fail(Errc::kCorrupt, "not a heartbeat");
  if (const auto version = in.read<std::uint16_t>(); version != kVersion) {
    return fail(Errc::kCorrupt, "the other end speaks version " + std::to_string(version) +
                                    ", this program version " + std::to_string(kVersion) +
                                    ": update the older one");
  }
  if (bytes.size() != kHeartbeat_bytes) return fail(Errc::kCorrupt, "a heartbeat has the wrong length");
  Heartbeat heartbeat;
  const auto mode = in.read<std::uint8_t>();
  heartbeat.mode = static_cast<OffloadMode>(mode);
  heartbeat.epoch.value = in.read<std::uint32_t>();
  heartbeat.seq = in.read<std::uint64_t>();
  heartbeat.map_hash = in.read<std::uint64_t>();
  heartbeat.queued_messages = in.read<std::uint32_t>();
  heartbeat.queued_bytes = in.read<std::uint64_t>();
  heartbeat.render_p95_ms = in.read<float>();
  heartbeat.memory_bytes = in.read<std::uint64_t>();
  heartbeat.goodput_bytes_per_s = in.read<float>();
  if (mode > static_cast<std::uint8_t>(OffloadMode::kFull) || !std::isfinite(heartbeat.render_p95_ms) ||
      !std::isfinite(heartbeat.goodput_bytes_per_s)) {
    return fail(Errc::kCorrupt, "a heartbeat's mode or numbers make no sense");
  }
  return heartbeat;
}

}  // namespace edgesplat::link
