// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/io/mcap_chunk_reader.hpp"
#include "common/io/mcap_index.hpp"

#include <algorithm>
#include <set>
#include <string>
#include <utility>

namespace edgesplat::io::mcap {
namespace {

/// Walks a file record by record and notes what is whole.
class Scanner {
 public:
  explicit Scanner(const ByteSource& source) : source_(source) { index_.report.used_summary = false; }

  Index run();

 private:
  /// Handles the record at `position_` and steps over it; false at the end of the data section.
  bool step();
  [[nodiscard]] bool is_plausible(const RecordPrefix& prefix) const;
  void resynchronise();
  void scan_chunk(const RecordPrefix& prefix);
  void scan_bare(const RecordPrefix& prefix);
  void scan_attachment(std::uint64_t length);
  void scan_metadata(std::uint64_t length);
  void finish_bare_run();
  void learn(ChunkPlace place, ChunkContents contents);
  void skip(std::uint64_t length, const std::string& why);

  const ByteSource& source_;
  Index index_;
  std::uint64_t position_ = kMagic.size();
  std::uint64_t bare_start_ = 0;
  std::uint64_t bare_bytes_ = 0;  ///< 0 = not in a run of records outside chunks
  bool closed_ = false;
};

void Scanner::skip(std::uint64_t length, const std::string& why) {
  add_problem(index_.report, why + " (byte " + std::to_string(position_) + ")");
  index_.report.bytes_skipped += length;
}

/// Counts messages, keeps definitions, remembers the place.
void Scanner::learn(ChunkPlace place, ChunkContents contents) {
  for (auto& schema : contents.schemas) index_.schemas.emplace(schema.id, std::move(schema));
  for (auto& channel : contents.channels) index_.channels.emplace(channel.id, std::move(channel));
  if (!place.is_bare) ++index_.statistics.chunk_count;
  if (contents.messages.empty()) return;
  const auto [first, last] = std::ranges::minmax_element(
      contents.messages, {}, [](const auto& message) { return message.log_time_ns; });
  place.first_log_time = host_time_from_ns(first->log_time_ns);
  place.last_log_time = host_time_from_ns(last->log_time_ns);
  auto& statistics = index_.statistics;
  const bool is_first = statistics.message_count == 0;
  statistics.first_log_time =
      is_first ? place.first_log_time : std::min(statistics.first_log_time, place.first_log_time);
  statistics.last_log_time =
      is_first ? place.last_log_time : std::max(statistics.last_log_time, place.last_log_time);
  statistics.message_count += contents.messages.size();
  std::set<McapChannelId> used;
  for (const auto& message : contents.messages) {
    ++statistics.messages_by_channel[message.channel];
    used.insert(message.channel);
  }
  place.channels.assign(used.begin(), used.end());
  index_.chunks.push_back(std::move(place));
}

void Scanner::finish_bare_run() {
  if (bare_bytes_ == 0) return;
  ChunkPlace place;
  place.offset = bare_start_;
  place.length = std::exchange(bare_bytes_, 0);
  place.is_bare = true;
  auto records = load_records(source_, place);
  auto contents = records ? list_records(*records) : tl::unexpected<Error>(records.error());
  if (!contents) {
    skip(place.length, contents.error().context);
    return;
  }
  learn(std::move(place), std::move(*contents));
}

void Scanner::scan_bare(const RecordPrefix& prefix) {
  constexpr std::uint64_t kLongestRunBytes = std::uint64_t{4} << 20U;
  const std::uint64_t length = kPrefixBytes + prefix.content_bytes;
  if (bare_bytes_ > 0 && bare_bytes_ + length > kLongestRunBytes) finish_bare_run();
  if (length > kMaxMcapRecordBytes) {
    skip(length, "a record outside chunks is too large");
    return;
  }
  if (bare_bytes_ == 0) bare_start_ = position_;
  bare_bytes_ += length;
}

void Scanner::scan_chunk(const RecordPrefix& prefix) {
  ChunkPlace place;
  place.offset = position_;
  place.length = kPrefixBytes + prefix.content_bytes;
  auto records = load_records(source_, place);
  auto contents = records ? list_records(*records) : tl::unexpected<Error>(records.error());
  if (!contents) {
    ++index_.report.chunks_skipped;
    skip(place.length, contents.error().context);
    return;
  }
  learn(std::move(place), std::move(*contents));
}

void Scanner::scan_attachment(std::uint64_t length) {
  if (length > kMaxMcapRecordBytes) {
    skip(length, "an attachment is too large");
    return;
  }
  const auto record = source_.read(position_, length);
  const auto attachment = record ? read_attachment(std::span(*record).subspan(kPrefixBytes))
                                 : tl::unexpected<Error>(record.error());
  if (!attachment) {
    skip(length, attachment.error().context);
    return;
  }
  AttachmentIndex place;
  place.offset = position_;
  place.length = length;
  place.log_time_ns = static_cast<std::uint64_t>(to_ns(attachment->log_time));
  place.content_bytes = attachment->content.size();
  place.name = attachment->name;
  place.media_type = attachment->media_type;
  index_.attachments.push_back(std::move(place));
  ++index_.statistics.attachment_count;
}

void Scanner::scan_metadata(std::uint64_t length) {
  const auto record = length <= kMaxMcapRecordBytes ? source_.read(position_, length)
                                                    : fail(Errc::kCorrupt, "a metadata record is too large");
  const auto metadata = record ? read_metadata(std::span(*record).subspan(kPrefixBytes))
                               : tl::unexpected<Error>(record.error());
  if (!metadata) {
    skip(length, metadata.error().context);
    return;
  }
  index_.metadata.push_back({position_, length, metadata->name});
  ++index_.statistics.metadata_count;
}

/// After a record that cannot be: on to the next chunk, or to the end.
void Scanner::resynchronise() {
  finish_bare_run();
  const auto next = find_chunk(source_, position_ + 1);
  const std::uint64_t end = next.value_or(source_.size_bytes());
  if (next) {
    skip(end - position_, "damaged records");
  } else {
    index_.report.bytes_skipped += end - position_;
    add_problem(index_.report, "recording truncated at byte " + std::to_string(position_) + ": kept " +
                                   std::to_string(index_.statistics.message_count) + " messages");
  }
  position_ = end;
}

/// Whether the record can be what its opcode says; if not, its length is not to be trusted either. Records of
/// no known kind count as damage: a flipped bit makes them more often than a writer does.
bool Scanner::is_plausible(const RecordPrefix& prefix) const {
  if (prefix.opcode == Opcode::kChunk) return find_chunk(source_, position_) == position_;
  if (prefix.opcode == Opcode::kMessageIndex) {
    constexpr std::uint64_t kFieldBytes = sizeof(std::uint16_t) + sizeof(std::uint32_t);
    const auto fields =
        source_.read(position_ + kPrefixBytes, std::min<std::uint64_t>(kFieldBytes, prefix.content_bytes));
    if (!fields) return false;
    ByteReader reader(*fields);
    reader.skip(sizeof(std::uint16_t));
    return reader.read<std::uint32_t>() + kFieldBytes == prefix.content_bytes && reader.ok();
  }
  return prefix.opcode >= Opcode::kHeader && prefix.opcode <= Opcode::kDataEnd;
}

bool Scanner::step() {
  const auto prefix = read_prefix(source_, position_);
  if (!prefix || !is_plausible(*prefix)) {
    if (prefix && prefix->opcode == Opcode::kChunk) ++index_.report.chunks_skipped;
    resynchronise();
    return position_ < source_.size_bytes();
  }
  const std::uint64_t length = kPrefixBytes + prefix->content_bytes;
  const bool is_bare = prefix->opcode == Opcode::kMessage || prefix->opcode == Opcode::kSchema ||
                       prefix->opcode == Opcode::kChannel;
  if (is_bare) {
    scan_bare(*prefix);
  } else {
    finish_bare_run();
  }
  if (prefix->opcode == Opcode::kChunk) scan_chunk(*prefix);
  if (prefix->opcode == Opcode::kAttachment) scan_attachment(length);
  if (prefix->opcode == Opcode::kMetadata) scan_metadata(length);
  position_ += length;
  closed_ = prefix->opcode == Opcode::kDataEnd || prefix->opcode == Opcode::kFooter;
  return !closed_ && position_ < source_.size_bytes();
}

Index Scanner::run() {
  while (position_ < source_.size_bytes() && step()) {
  }
  finish_bare_run();
  if (!closed_ && index_.report.complete) {
    add_problem(index_.report, "recording was not closed (it ends at byte " + std::to_string(position_) +
                                   "): kept " + std::to_string(index_.statistics.message_count) +
                                   " messages");
  }
  return std::move(index_);
}

}  // namespace

Index index_by_scanning(const ByteSource& source) {
  return Scanner(source).run();
}

}  // namespace edgesplat::io::mcap
