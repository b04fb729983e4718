// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/io/rosbag1_index.hpp"

#include <algorithm>
#include <string>
#include <utility>

namespace edgesplat::io::rosbag1 {
namespace {

constexpr std::uint64_t kMaxIndexBytes = std::uint64_t{256} << 20U;

bool is(const RecordHeader& header, Op op) {
  return header.op == static_cast<std::uint8_t>(op);
}

void add_connection(Index& index, const Connection& connection) {
  if (index.topic_of.contains(connection.id)) return;
  const std::string type = ros_type_name(connection.type);
  const auto same = [&](const BagTopic& topic) {
    return topic.name == connection.topic && topic.type == type;
  };
  const auto place = std::find_if(index.topics.begin(), index.topics.end(), same);
  index.topic_of.emplace(connection.id, static_cast<std::size_t>(place - index.topics.begin()));
  if (place == index.topics.end()) index.topics.push_back({connection.topic, type, RosEncoding::kRos1});
}

/// The records from index_pos to the end.
Result<Index> index_from_end(const ByteSource& source, const RecordHeader& bag) {
  if (bag.index_pos == 0 || bag.index_pos >= source.size_bytes())
    return fail(Errc::kNotFound, "the bag was not closed");
  const std::uint64_t length = source.size_bytes() - bag.index_pos;
  if (length > kMaxIndexBytes) return fail(Errc::kCorrupt, "the index is too large");
  EDGESPLAT_TRY(const auto bytes, source.read(bag.index_pos, length));
  Index index;
  std::uint64_t connections = 0;
  for (std::size_t at = 0; at < bytes.size();) {
    EDGESPLAT_TRY(const Record record, read_record(std::span(bytes).subspan(at)));
    at += record.total_bytes;
    if (is(record.header, Op::kConnection)) {
      EDGESPLAT_TRY(const Connection connection, read_connection(record));
      add_connection(index, connection);
      ++connections;
    } else if (is(record.header, Op::kChunkInfo)) {
      const RecordHeader& h = record.header;
      if (h.chunk_pos >= bag.index_pos || h.start_time_ns > h.end_time_ns)
        return fail(Errc::kCorrupt, "the index is damaged");
      index.chunks.push_back({h.chunk_pos, h.start_time_ns, h.end_time_ns});
    }
  }
  if (connections != bag.connection_count || index.chunks.size() != bag.chunk_count)
    return fail(Errc::kCorrupt, "the index is not whole");
  return index;
}

/// Adds one chunk to the index by what it holds.
void add_chunk(Index& index, const ByteSource& source, std::uint64_t offset, const RecordPlace& place) {
  const auto skip = [&](const Error& error) {
    index.report.bytes_skipped += place.data_bytes;
    add_problem(index.report, error.context + " (byte " + std::to_string(offset) + ")");
  };
  const auto records = load_chunk(source, offset);
  if (!records) return skip(records.error());
  const auto contents = list_chunk(*records);
  if (!contents) return skip(contents.error());
  for (const Connection& connection : contents->connections) add_connection(index, connection);
  if (contents->messages.empty()) return;
  const auto [first, last] = std::ranges::minmax_element(contents->messages, {}, &MessagePlace::time_ns);
  index.chunks.push_back({offset, first->time_ns, last->time_ns});
}

Index index_by_scanning(const ByteSource& source, std::uint64_t offset) {
  Index index;
  while (offset < source.size_bytes()) {
    const auto place = read_record_place(source, offset);
    if (!place) {
      index.report.bytes_skipped += source.size_bytes() - offset;
      add_problem(index.report, "the bag is truncated or damaged at byte " + std::to_string(offset) +
                                    ": kept " + std::to_string(index.chunks.size()) + " chunks");
      break;
    }
    if (is(place->header, Op::kChunk)) add_chunk(index, source, offset, *place);
    offset = place->end_offset();
  }
  return index;
}

}  // namespace

void add_problem(BagReport& report, std::string_view sentence) {
  report.complete = false;
  constexpr std::size_t kLongest = 1000;
  if (report.why.size() < kLongest) report.why += (report.why.empty() ? "" : "; ") + std::string(sentence);
}

Result<Index> read_index(const ByteSource& source) {
  const auto magic = source.read(0, std::min<std::uint64_t>(source.size_bytes(), kMagic.size()));
  if (!magic) return tl::unexpected<Error>(magic.error());
  const std::string_view text(reinterpret_cast<const char*>(magic->data()), magic->size());
  if (text != kMagic) {
    return fail(Errc::kCorrupt, text.starts_with("#ROSBAG V1")
                                    ? "a bag of format 1: bring it to 2.0 with rosbag fix"
                                    : "not a ROS bag of format 2.0");
  }
  EDGESPLAT_TRY(const RecordPlace bag, read_record_place(source, kMagic.size()));
  if (!is(bag.header, Op::kBagHeader)) return fail(Errc::kCorrupt, "the bag does not begin with its header");
  auto from_end = index_from_end(source, bag.header);
  if (from_end) return from_end;
  Index index = index_by_scanning(source, bag.end_offset());
  if (index.report.complete && from_end.error().code != Errc::kNotFound)
    add_problem(index.report, from_end.error().context + ": read without it");
  return index;
}

}  // namespace edgesplat::io::rosbag1
