// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/io/mcap_merge.hpp"

#include <algorithm>
#include <string>
#include <tuple>
#include <utility>

namespace edgesplat::io::mcap {

MessageMerge::MessageMerge(const ByteSource& source, const Index& index, McapSelection selection)
    : source_(source), index_(index), selection_(std::move(selection)), report_(index.report) {
  for (const auto& [id, channel] : index.channels) {
    const bool wanted = selection_.topics.empty() ||
                        std::ranges::find(selection_.topics, channel.topic) != selection_.topics.end();
    if (wanted) channels_.insert(id);
  }
  for (const auto& place : index.chunks) {
    if (is_selected(place)) pending_.push_back(&place);
  }
  std::ranges::sort(pending_, {},
                    [](const ChunkPlace* place) { return std::tuple(place->first_log_time, place->offset); });
}

bool MessageMerge::is_selected(const ChunkPlace& place) const {
  if (place.last_log_time < selection_.from || place.first_log_time >= selection_.until) return false;
  if (place.channels.empty()) return true;
  return std::ranges::any_of(place.channels, [this](McapChannelId id) {
    // Messages of a channel that was never defined are looked at, so that they are counted as lost.
    return channels_.contains(id) || !index_.channels.contains(id);
  });
}

void MessageMerge::skip_chunk(const ChunkPlace& place, const Error& error) {
  ++report_.chunks_skipped;
  report_.bytes_skipped += place.length;
  add_problem(report_, error.context + " (byte " + std::to_string(place.offset) + ")");
}

void MessageMerge::keep_selected(std::vector<MessagePlace>& messages) {
  std::uint64_t without_channel = 0;
  std::erase_if(messages, [&](const MessagePlace& message) {
    if (!index_.channels.contains(message.channel)) ++without_channel;
    const auto time = host_time_from_ns(message.log_time_ns);
    return !channels_.contains(message.channel) || time < selection_.from || time >= selection_.until;
  });
  if (without_channel > 0) {
    add_problem(report_, std::to_string(without_channel) + " messages belong to no known channel");
  }
  std::ranges::stable_sort(messages, {}, &MessagePlace::log_time_ns);
}

Status MessageMerge::open_chunk(const ChunkPlace& place) {
  auto chunk = std::make_unique<OpenChunk>();
  chunk->place = &place;
  EDGESPLAT_TRY(chunk->records, load_records(source_, place));
  EDGESPLAT_TRY(auto contents, list_records(chunk->records));
  chunk->messages = std::move(contents.messages);
  for (const auto& message : chunk->messages) {
    const auto time = host_time_from_ns(message.log_time_ns);
    if (time < place.first_log_time || time > place.last_log_time) {
      return fail(Errc::kCorrupt, "a chunk holds other times than its index says");
    }
  }
  keep_selected(chunk->messages);
  if (chunk->messages.empty()) return {};
  open_.add(std::move(chunk));
  return {};
}

void MessageMerge::open_due_chunks() {
  while (next_pending_ < pending_.size()) {
    const ChunkPlace& place = *pending_[next_pending_];
    if (!open_.empty() && to_ns(place.first_log_time) > std::get<0>(open_.front().key())) return;
    ++next_pending_;
    if (auto opened = open_chunk(place); !opened) skip_chunk(place, opened.error());
    open_.give_back_memory();
  }
}

std::optional<McapMessage> MessageMerge::next() {
  open_.put_back_current();
  while (true) {
    open_due_chunks();
    if (open_.empty()) return std::nullopt;
    OpenChunk& chunk = open_.take_front();
    if (!chunk.records.empty()) break;
    const Status loaded = open_.restore_current(load_records(source_, *chunk.place));
    if (loaded) {
      open_.give_back_memory();
      break;
    }
    skip_chunk(*chunk.place, loaded.error());
    open_.forget_current();
  }
  OpenChunk& current = open_.current();
  const MessagePlace& place = current.messages[current.next++];
  const auto content = std::span<const std::byte>(current.records).subspan(place.offset, place.content_bytes);
  const auto header = read_message_header(content);
  McapMessage message;
  message.channel = &index_.channels.find(place.channel)->second;
  message.sequence = header->sequence;
  message.log_time = host_time_from_ns(place.log_time_ns);
  message.publish_time = sensor_time_from_ns(static_cast<std::int64_t>(header->publish_time_ns));
  message.payload = content.subspan(kMessageHeaderBytes);
  ++report_.messages_read;
  return message;
}

}  // namespace edgesplat::io::mcap
