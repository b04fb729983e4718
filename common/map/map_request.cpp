// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/map/map_request.hpp"

#include "common/base/bytes.hpp"
#include "common/base/crc32c.hpp"

#include <algorithm>
#include <string>

namespace edgesplat::map {
namespace {

constexpr std::size_t kFixed_bytes = 4 + 2 + 1 + 2 + 4 + 8 + 8 + 12 + 2 + 4;
constexpr std::size_t kChunk_bytes = 12;

}  // namespace

std::string_view to_string(RequestKind kind) {
  switch (kind) {
    case RequestKind::kResend:
      return "resend";
    case RequestKind::kSnapshot:
      return "snapshot";
    case RequestKind::kMore:
      return "more";
    case RequestKind::kRelease:
      return "release";
    case RequestKind::kFetch:
      return "fetch";
  }
  return "unknown";
}

std::vector<std::byte> encode_map_request(const MapRequest& request) {
  ByteWriter out;
  out.write(kMapRequestMagic);
  out.write(kMapRequestVersion);
  out.write(static_cast<std::uint8_t>(request.kind));
  out.write(request.robot.value);
  out.write(request.epoch.value);
  out.write(request.seq);
  out.write(request.until_seq);
  for (const float v : request.robot_in_map_m) out.write(v);
  const std::size_t count = std::min(request.chunks.size(), kMaxRequestChunks);
  out.write(static_cast<std::uint16_t>(count));
  for (std::size_t i = 0; i < count; ++i) {
    out.write(request.chunks[i].x);
    out.write(request.chunks[i].y);
    out.write(request.chunks[i].z);
  }
  out.write(crc32c(out.bytes()));
  return out.take();
}

Result<MapRequest> decode_map_request(std::span<const std::byte> bytes) {
  if (bytes.size() < kFixed_bytes || bytes.size() > kFixed_bytes + kChunk_bytes * kMaxRequestChunks)
    return fail(Errc::kCorrupt, "a map request of " + std::to_string(bytes.size()) + " bytes cannot be one");
  ByteReader in(bytes);
  if (in.read<std::uint32_t>() != kMapRequestMagic || in.read<std::uint16_t>() != kMapRequestVersion)
    return fail(Errc::kCorrupt, "not a map request of a version this program reads: update the older end");
  MapRequest request;
  const auto kind = in.read<std::uint8_t>();
  request.kind = static_cast<RequestKind>(kind);
  request.robot.value = in.read<std::uint16_t>();
  request.epoch.value = in.read<std::uint32_t>();
  request.seq = in.read<std::uint64_t>();
  request.until_seq = in.read<std::uint64_t>();
  for (float& v : request.robot_in_map_m) v = in.read<float>();
  const std::size_t count = in.read<std::uint16_t>();
  if (bytes.size() != kFixed_bytes + kChunk_bytes * count)
    return fail(Errc::kCorrupt, "a map request's length does not match");
  bool chunks_in_map = true;
  for (std::size_t i = 0; i < count; ++i) {
    ChunkId chunk;
    chunk.x = in.read<std::int32_t>();
    chunk.y = in.read<std::int32_t>();
    chunk.z = in.read<std::int32_t>();
    chunks_in_map = chunks_in_map && chunk_in_map(chunk);
    request.chunks.push_back(chunk);
  }
  if (in.read<std::uint32_t>() != crc32c(bytes.first(bytes.size() - sizeof(std::uint32_t))))
    return fail(Errc::kCorrupt, "a map request's CRC32C does not match");
  if (kind < static_cast<std::uint8_t>(RequestKind::kResend) ||
      kind > static_cast<std::uint8_t>(RequestKind::kFetch) || !request.robot_in_map_m.allFinite() ||
      !chunks_in_map)
    return fail(Errc::kCorrupt, "a map request's kind, position or chunks make no sense");
  return request;
}

}  // namespace edgesplat::map
