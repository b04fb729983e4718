// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/io/mcap_recover.hpp"

#include "common/base/unique_fd.hpp"
#include "common/io/atomic_file.hpp"
#include "common/io/mcap_chunk_reader.hpp"
#include "common/io/mcap_index.hpp"
#include "common/io/mcap_summary_writer.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>
#include <utility>

namespace edgesplat::io {
namespace {

using mcap::ChunkIndex;
using mcap::ChunkPlace;
using mcap::kPrefixBytes;
using mcap::Opcode;

Error system_error(const std::string& what, const std::filesystem::path& path) {
  return Error{Errc::kIo, what + " " + path.string() + ": " + std::generic_category().message(errno)};
}

/// The chunk's entry of the summary, from the record and the message indexes that follow it.
Result<ChunkIndex> index_chunk(const ByteSource& source, const ChunkPlace& place) {
  constexpr std::uint64_t kLongestPrefix = 256;  // fixed fields and a short name
  const std::uint64_t content = std::min(kLongestPrefix, place.length - kPrefixBytes);
  EDGESPLAT_TRY(const auto start, source.read(place.offset + kPrefixBytes, content));
  EDGESPLAT_TRY(const auto prefix, mcap::read_chunk_prefix(start));
  ChunkIndex index;
  index.first_log_time_ns = static_cast<std::uint64_t>(to_ns(place.first_log_time));  // as its messages say
  index.last_log_time_ns = static_cast<std::uint64_t>(to_ns(place.last_log_time));
  index.chunk_offset = place.offset;
  index.chunk_length = place.length;
  index.compression = prefix.header.compression;
  index.compressed_bytes = prefix.header.compressed_bytes;
  index.uncompressed_bytes = prefix.header.uncompressed_bytes;
  std::uint64_t at = place.offset + place.length;
  while (at < source.size_bytes()) {
    const auto record = mcap::read_prefix(source, at);
    if (!record || record->opcode != Opcode::kMessageIndex) break;
    EDGESPLAT_TRY(const auto id, source.read(at + kPrefixBytes, sizeof(std::uint16_t)));
    index.message_index_offsets[McapChannelId{ByteReader(id).read<std::uint16_t>()}] = at;
    at += kPrefixBytes + record->content_bytes;
  }
  index.message_index_bytes = at - place.offset - place.length;
  return index;
}

bool has_every_index(const ChunkIndex& index, const ChunkPlace& place) {
  return std::ranges::all_of(place.channels,
                             [&](McapChannelId id) { return index.message_index_offsets.contains(id); });
}

/// The message indexes of a chunk, to be written right after it.
Result<std::vector<std::byte>> make_message_indexes(const ByteSource& source, const ChunkPlace& place,
                                                    ChunkIndex& index) {
  EDGESPLAT_TRY(const auto records, mcap::load_records(source, place));
  EDGESPLAT_TRY(const auto contents, mcap::list_records(records));
  const std::uint64_t file_offset = place.offset + place.length;
  index.message_index_offsets.clear();
  ByteWriter out;
  for (const McapChannelId channel : place.channels) {
    index.message_index_offsets[channel] = file_offset + out.size();
    ByteWriter entries;
    for (const mcap::MessagePlace& message : contents.messages) {
      if (message.channel != channel) continue;
      entries.write(static_cast<std::uint64_t>(message.log_time_ns));
      entries.write(static_cast<std::uint64_t>(message.offset) - kPrefixBytes);
    }
    const mcap::RecordScope record(out, Opcode::kMessageIndex);
    out.write(channel.value);
    out.write(static_cast<std::uint32_t>(entries.size()));
    out.write_bytes(entries.bytes());
  }
  index.message_index_bytes = out.size();
  return out.take();
}

/// What to keep of a file, and what to write behind it.
struct Repair {
  std::uint64_t keep_bytes = mcap::kMagic.size();
  std::vector<std::byte> message_indexes;  ///< of the last chunk, where they are missing
  mcap::Summary summary;
};

Result<Repair> plan_repair(const ByteSource& source, const mcap::Index& found) {
  Repair repair;
  for (const auto& [id, schema] : found.schemas) repair.summary.schemas.push_back(schema);
  for (const auto& [id, channel] : found.channels) repair.summary.channels.push_back(channel);
  repair.summary.attachments = found.attachments;
  repair.summary.metadata = found.metadata;
  repair.summary.statistics = found.statistics;
  repair.summary.statistics.chunk_count = 0;
  for (const auto& one : found.attachments)
    repair.keep_bytes = std::max(repair.keep_bytes, one.offset + one.length);
  for (const auto& one : found.metadata)
    repair.keep_bytes = std::max(repair.keep_bytes, one.offset + one.length);
  for (ChunkPlace place : found.chunks) {
    // Messages of a channel that nobody defined stay where they are; no index leads to them.
    std::erase_if(place.channels, [&](McapChannelId id) { return !found.channels.contains(id); });
    if (place.is_bare)
      return fail(
          Errc::kInvalidArgument,
          "it has messages outside chunks, as edgesplat writes none: recover it with its writer's tools");
    EDGESPLAT_TRY(ChunkIndex index, index_chunk(source, place));
    const std::uint64_t end = place.offset + place.length + index.message_index_bytes;
    if (end > repair.keep_bytes) {
      repair.keep_bytes = end;
      if (!has_every_index(index, place)) {
        EDGESPLAT_TRY(repair.message_indexes, make_message_indexes(source, place, index));
        repair.keep_bytes = place.offset + place.length;
      } else {
        repair.message_indexes.clear();
      }
    }
    std::erase_if(index.message_index_offsets,
                  [&](const auto& entry) { return !found.channels.contains(entry.first); });
    repair.summary.chunks.push_back(std::move(index));
    ++repair.summary.statistics.chunk_count;
  }
  return repair;
}

Status write_repair(int fd, const std::filesystem::path& path, const Repair& repair) {
  if (::ftruncate(fd, static_cast<off_t>(repair.keep_bytes)) != 0)
    return tl::unexpected(system_error("cannot cut", path));
  if (::lseek(fd, 0, SEEK_END) < 0) return tl::unexpected(system_error("cannot write to", path));
  EDGESPLAT_TRY_STATUS(write_all(fd, repair.message_indexes, path));
  const std::uint64_t end = repair.keep_bytes + repair.message_indexes.size();
  EDGESPLAT_TRY_STATUS(write_all(fd, mcap::encode_file_end(repair.summary, end), path));
  if (::fsync(fd) != 0) return tl::unexpected(system_error("cannot sync", path));
  return {};
}

}  // namespace

Result<McapRecovery> recover_mcap(const std::filesystem::path& path) {
  EDGESPLAT_TRY(const auto source, open_byte_source(path));
  const auto magic = source->read(0, std::min<std::uint64_t>(source->size_bytes(), mcap::kMagic.size()));
  if (!magic || !std::ranges::equal(*magic, mcap::kMagic))
    return fail(Errc::kCorrupt, path.string() + " is no MCAP file");
  McapRecovery recovery;
  if (const auto whole = mcap::index_from_summary(*source)) {
    recovery.was_whole = true;
    recovery.statistics = whole->statistics;
    return recovery;
  }
  const UniqueFd fd(::open(path.c_str(), O_WRONLY | O_CLOEXEC));
  if (!fd.valid()) return tl::unexpected(system_error("cannot change", path));
  if (::flock(fd.get(), LOCK_EX | LOCK_NB) != 0)
    return fail(Errc::kUnavailable, path.string() + " is being written: wait until its program has ended");
  const mcap::Index found = mcap::index_by_scanning(*source);
  if (found.statistics.message_count == 0)
    return fail(Errc::kCorrupt, path.string() + " holds no whole chunk: there is nothing to recover");
  auto repair = plan_repair(*source, found);
  if (!repair) return fail(repair.error().code, path.string() + ": " + repair.error().context);
  recovery.statistics = found.statistics;
  recovery.bytes_cut = source->size_bytes() - repair->keep_bytes;
  recovery.chunks_skipped = found.report.chunks_skipped;
  recovery.why = found.report.complete ? "its end was damaged" : found.report.why;
  EDGESPLAT_TRY_STATUS(write_repair(fd.get(), path, *repair));
  return recovery;
}

}  // namespace edgesplat::io
