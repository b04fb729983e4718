// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/io/mcap_index.hpp"

#include "common/io/mcap_compression.hpp"

#include <algorithm>
#include <array>

namespace edgesplat::io::mcap {
namespace {

/// Longest prefix of a chunk record: fields and a compression name of four letters.
constexpr std::size_t kChunkProbeBytes = kPrefixBytes + 8 + 8 + 8 + 4 + 4 + 4 + 8;

/// Whether the bytes may begin a chunk record of at most `available` bytes.
bool looks_like_chunk(std::span<const std::byte> bytes, std::uint64_t available) {
  ByteReader reader(bytes);
  const auto opcode = static_cast<Opcode>(reader.read<std::uint8_t>());
  const auto content_bytes = reader.read<std::uint64_t>();
  if (opcode != Opcode::kChunk || content_bytes > available - kPrefixBytes) return false;
  const auto prefix = read_chunk_prefix(bytes.subspan(kPrefixBytes));
  return prefix && compression_from_string(prefix->header.compression) &&
         prefix->header.uncompressed_bytes <= kMaxMcapRecordBytes &&
         prefix->header.compressed_bytes <= content_bytes &&
         prefix->header_bytes + prefix->header.compressed_bytes == content_bytes;
}

}  // namespace

void add_problem(McapReadReport& report, std::string_view sentence) {
  constexpr std::size_t kLongestReport = 400;  // a file may have any number of problems
  report.complete = false;
  if (report.why.size() > kLongestReport) return;
  if (!report.why.empty()) report.why += "; ";
  report.why += sentence;
}

Result<RecordPrefix> read_prefix(const ByteSource& source, std::uint64_t offset) {
  std::array<std::byte, kPrefixBytes> bytes{};
  EDGESPLAT_TRY_STATUS(source.read(offset, std::span(bytes)));
  ByteReader reader(bytes);
  const auto opcode = static_cast<Opcode>(reader.read<std::uint8_t>());
  const auto content_bytes = reader.read<std::uint64_t>();
  if (content_bytes > source.size_bytes() - offset - kPrefixBytes) {
    return fail(Errc::kCorrupt, "a record is longer than the rest of the file");
  }
  return RecordPrefix{opcode, content_bytes};
}

std::optional<std::uint64_t> find_chunk(const ByteSource& source, std::uint64_t offset) {
  std::uint64_t window_bytes = 4096;  // grows, so that many small gaps do not each cost a large read
  constexpr std::uint64_t kLargestWindowBytes = std::uint64_t{1} << 20U;
  while (offset < source.size_bytes() && source.size_bytes() - offset > kPrefixBytes) {
    const std::uint64_t length = std::min(window_bytes, source.size_bytes() - offset);
    const auto window = source.read(offset, length);
    if (!window) return std::nullopt;
    const bool at_end = offset + length == source.size_bytes();
    const std::size_t starts = at_end ? window->size() - kPrefixBytes : window->size() - kChunkProbeBytes + 1;
    for (std::size_t i = 0; i < starts; ++i) {
      if ((*window)[i] != static_cast<std::byte>(Opcode::kChunk)) continue;
      const auto rest = std::span(*window).subspan(i);
      const auto probe = rest.first(std::min(rest.size(), kChunkProbeBytes));
      if (looks_like_chunk(probe, source.size_bytes() - offset - i)) return offset + i;
    }
    if (at_end) break;
    offset += starts;
    window_bytes = std::min(window_bytes * 2, kLargestWindowBytes);
  }
  return std::nullopt;
}

}  // namespace edgesplat::io::mcap
