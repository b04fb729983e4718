// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/map/delta_header.hpp"

#include "common/base/crc32c.hpp"

#include <algorithm>
#include <string>

namespace edgesplat::map {
namespace {

constexpr std::size_t kCrcOffset_bytes = kDeltaHeader_bytes - sizeof(std::uint32_t);

void write_header(ByteWriter& out, const DeltaHeader& header) {
  out.write(kDeltaMagic);
  out.write(kDeltaVersion);
  out.write(header.robot.value);
  out.write_bytes(header.map.bytes);
  out.write(header.epoch.value);
  out.write(header.seq);
  out.write(header.base_seq);
  out.write(static_cast<std::uint8_t>(header.kind));
  out.write(header.count);
  out.write(header.length_bytes);
  out.write(std::uint32_t{0});  // the CRC's place
}

}  // namespace

std::vector<std::byte> seal_delta(DeltaHeader header, std::span<const std::byte> body) {
  header.length_bytes = static_cast<std::uint32_t>(body.size());
  ByteWriter out;
  out.reserve(kDeltaHeader_bytes + body.size());
  write_header(out, header);
  out.write_bytes(body);
  const auto before = crc32c(out.bytes().first(kCrcOffset_bytes));
  out.patch(kCrcOffset_bytes, crc32c(body, before));
  return out.take();
}

Result<DeltaHeader> decode_delta_header(std::span<const std::byte> bytes) {
  if (bytes.size() < kDeltaHeader_bytes || bytes.size() > kMaxDelta_bytes) {
    return fail(Errc::kCorrupt, "a delta of " + std::to_string(bytes.size()) + " bytes cannot be one");
  }
  ByteReader in(bytes);
  if (in.read<std::uint32_t>() != kDeltaMagic) return fail(Errc::kCorrupt, "not a delta: wrong magic number");
  if (const auto version = in.read<std::uint16_t>(); version != kDeltaVersion) {
    return fail(Errc::kCorrupt, "delta of version " + std::to_string(version) + ", this program reads " +
                                    std::to_string(kDeltaVersion) + ": update the older end");
  }
  DeltaHeader header;
  header.robot.value = in.read<std::uint16_t>();
  const auto uuid = in.take(16);
  std::copy(uuid.begin(), uuid.end(), header.map.bytes.begin());
  header.epoch.value = in.read<std::uint32_t>();
  header.seq = in.read<std::uint64_t>();
  header.base_seq = in.read<std::uint64_t>();
  const auto kind = in.read<std::uint8_t>();
  header.kind = static_cast<DeltaKind>(kind);
  header.count = in.read<std::uint32_t>();
  header.length_bytes = in.read<std::uint32_t>();
  const auto stated_crc = in.read<std::uint32_t>();
  if (header.length_bytes != in.remaining()) return fail(Errc::kCorrupt, "a delta's length does not match");
  const auto actual_crc = crc32c(bytes.subspan(kDeltaHeader_bytes), crc32c(bytes.first(kCrcOffset_bytes)));
  if (stated_crc != actual_crc) return fail(Errc::kCorrupt, "a delta's CRC32C does not match");
  if (kind < static_cast<std::uint8_t>(DeltaKind::kAdd) ||
      kind > static_cast<std::uint8_t>(DeltaKind::kMapped)) {
    return fail(Errc::kCorrupt, "a delta of unknown kind " + std::to_string(kind));
  }
  if (header.seq == 0 || header.base_seq >= header.seq) {
    return fail(Errc::kCorrupt, "a delta's sequence numbers make no sense");
  }
  return header;
}

std::string_view to_string(DeltaKind kind) {
  switch (kind) {
    case DeltaKind::kAdd:
      return "add";
    case DeltaKind::kUpdate:
      return "update";
    case DeltaKind::kRemove:
      return "remove";
    case DeltaKind::kChunkReplace:
      return "chunk_replace";
    case DeltaKind::kRepose:
      return "repose";
    case DeltaKind::kMask:
      return "mask";
    case DeltaKind::kMapped:
      return "mapped";
  }
  return "unknown";
}

}  // namespace edgesplat::map
