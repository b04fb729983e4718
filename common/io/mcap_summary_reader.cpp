// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/io/mcap_index.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace edgesplat::io::mcap {
namespace {

constexpr std::size_t kFileEndBytes = kPrefixBytes + kFooterContentBytes + kMagic.size();

/// A proper file without (enough of) a summary: nothing is wrong with it.
tl::unexpected<Error> absent(std::string_view why) {
  return fail(Errc::kNotFound, "the summary " + std::string(why));
}

tl::unexpected<Error> unusable(std::string_view why) {
  return fail(Errc::kCorrupt, "the summary " + std::string(why));
}

Result<Footer> read_file_end(const ByteSource& source) {
  std::array<std::byte, kFileEndBytes> bytes{};
  if (source.size_bytes() < kMagic.size() + kFileEndBytes) return unusable("is missing");
  EDGESPLAT_TRY_STATUS(source.read(source.size_bytes() - kFileEndBytes, std::span(bytes)));
  const auto magic = std::span(bytes).last(kMagic.size());
  ByteReader reader(bytes);
  const auto opcode = static_cast<Opcode>(reader.read<std::uint8_t>());
  const auto content_bytes = reader.read<std::uint64_t>();
  if (!std::ranges::equal(magic, kMagic) || opcode != Opcode::kFooter ||
      content_bytes != kFooterContentBytes) {
    return unusable("is missing");
  }
  EDGESPLAT_TRY(const Footer footer, read_footer(reader.take(kFooterContentBytes)));
  if (footer.summary_start == 0) return absent("was left out");
  if (footer.summary_start < kMagic.size() || footer.summary_start > source.size_bytes() - kFileEndBytes) {
    return unusable("lies outside the file");
  }
  return footer;
}

ChunkPlace to_place(const ChunkIndex& chunk) {
  ChunkPlace place;
  place.offset = chunk.chunk_offset;
  place.length = chunk.chunk_length;
  place.first_log_time = host_time_from_ns(static_cast<std::int64_t>(chunk.first_log_time_ns));
  place.last_log_time = host_time_from_ns(static_cast<std::int64_t>(chunk.last_log_time_ns));
  for (const auto& [channel, offset] : chunk.message_index_offsets) place.channels.push_back(channel);
  return place;
}

Status read_summary_record(Opcode opcode, std::span<const std::byte> content, Index& index,
                           bool& has_statistics) {
  switch (opcode) {
    case Opcode::kSchema: {
      EDGESPLAT_TRY(auto schema, read_schema(content));
      index.schemas.emplace(schema.id, std::move(schema));
      return {};
    }
    case Opcode::kChannel: {
      EDGESPLAT_TRY(auto channel, read_channel(content));
      index.channels.emplace(channel.id, std::move(channel));
      return {};
    }
    case Opcode::kStatistics: {
      EDGESPLAT_TRY(index.statistics, read_statistics(content));
      has_statistics = true;
      return {};
    }
    case Opcode::kChunkIndex: {
      EDGESPLAT_TRY(const auto chunk, read_chunk_index(content));
      index.chunks.push_back(to_place(chunk));
      return {};
    }
    case Opcode::kAttachmentIndex: {
      EDGESPLAT_TRY(auto attachment, read_attachment_index(content));
      index.attachments.push_back(std::move(attachment));
      return {};
    }
    case Opcode::kMetadataIndex: {
      EDGESPLAT_TRY(auto metadata, read_metadata_index(content));
      index.metadata.push_back(std::move(metadata));
      return {};
    }
    default:
      return {};
  }
}

/// The summary must account for all that the statistics promise, or messages would be missed silently.
Status check_summary(const Index& index, std::uint64_t summary_start) {
  const auto& statistics = index.statistics;
  if (statistics.chunk_count != index.chunks.size() ||
      statistics.attachment_count != index.attachments.size() ||
      statistics.metadata_count != index.metadata.size()) {
    return unusable("does not list everything");
  }
  if (statistics.message_count > 0 && index.chunks.empty()) return absent("knows no chunks");
  const auto is_inside = [summary_start](const auto& place) {
    return place.offset >= kMagic.size() && place.offset <= summary_start && place.length >= kPrefixBytes &&
           place.length <= summary_start - place.offset;
  };
  if (!std::ranges::all_of(index.chunks, is_inside) || !std::ranges::all_of(index.attachments, is_inside) ||
      !std::ranges::all_of(index.metadata, is_inside)) {
    return unusable("points outside the data");
  }
  const auto is_known = [&index](McapChannelId id) { return index.channels.contains(id); };
  for (const auto& chunk : index.chunks) {
    if (!std::ranges::all_of(chunk.channels, is_known)) return unusable("lacks a channel");
  }
  return {};
}

}  // namespace

Result<Index> index_from_summary(const ByteSource& source) {
  EDGESPLAT_TRY(const Footer footer, read_file_end(source));
  const std::uint64_t end = source.size_bytes() - kMagic.size() - sizeof(std::uint32_t);
  const std::uint64_t checked_bytes = end - footer.summary_start;  // up to the footer's own checksum
  if (checked_bytes > kMaxMcapRecordBytes) return unusable("is too large");
  EDGESPLAT_TRY(const auto bytes, source.read(footer.summary_start, checked_bytes));
  if (footer.summary_crc != 0 && footer.summary_crc != crc32(bytes)) return unusable("fails its checksum");

  Index index;
  bool has_statistics = false;
  ByteReader reader(
      std::span<const std::byte>(bytes).first(bytes.size() - kPrefixBytes - 2 * sizeof(std::uint64_t)));
  while (reader.remaining() > 0) {
    const auto opcode = static_cast<Opcode>(reader.read<std::uint8_t>());
    const auto content = reader.take(reader.read<std::uint64_t>());
    if (!reader.ok()) return unusable("is damaged");
    EDGESPLAT_TRY_STATUS(read_summary_record(opcode, content, index, has_statistics));
  }
  if (!has_statistics) return absent("has no statistics");
  EDGESPLAT_TRY_STATUS(check_summary(index, footer.summary_start));
  return index;
}

}  // namespace edgesplat::io::mcap
