// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/io/rosbag1.hpp"

#include "common/io/open_chunks.hpp"
#include "common/io/rosbag1_index.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

namespace edgesplat::io {
namespace {

using rosbag1::ChunkPlace;
using rosbag1::MessagePlace;

/// Walks the chunks in time order: one is opened when its first message is due; while more than the budget is
/// open, those whose next message is furthest away give their bytes back.
class Rosbag1 final : public BagSource {
 public:
  Rosbag1(std::unique_ptr<ByteSource> source, rosbag1::Index index)
      : source_(std::move(source)), index_(std::move(index)) {
    for (const ChunkPlace& chunk : index_.chunks) {
      begin_ns_ = begin_ns_ ? std::min(*begin_ns_, chunk.first_ns) : chunk.first_ns;
      end_ns_ = std::max(end_ns_, chunk.last_ns);
    }
    start(std::vector<bool>(index_.topics.size(), true));
  }

  [[nodiscard]] const std::vector<BagTopic>& topics() const override { return index_.topics; }
  [[nodiscard]] HostTime begin() const override { return host_time_from_ns(begin_ns_.value_or(0)); }
  [[nodiscard]] HostTime end() const override { return host_time_from_ns(end_ns_); }
  void select(std::vector<std::size_t> topics) override {
    std::vector<bool> wanted(index_.topics.size(), false);
    for (const std::size_t topic : topics) wanted.at(topic) = true;
    start(std::move(wanted));
  }
  [[nodiscard]] std::optional<BagMessage> next() override;
  [[nodiscard]] BagReport report() const override { return report_; }

 private:
  struct OpenChunk {
    const ChunkPlace* place = nullptr;
    std::vector<std::byte> records;  ///< empty = given back, loaded again when due
    std::size_t records_bytes = 0;
    std::vector<MessagePlace> messages;  ///< selected ones, by time
    std::size_t next = 0;
    [[nodiscard]] std::tuple<std::int64_t, std::uint64_t> key() const {
      return {messages[next].time_ns, place->offset};
    }
  };
  void start(std::vector<bool> wanted);
  void open_due_chunks();
  [[nodiscard]] Status open_chunk(const ChunkPlace& place);
  void keep_selected(std::vector<MessagePlace>& messages, const ChunkPlace& place);
  void skip_chunk(const ChunkPlace& place, const Error& error) {
    rosbag1::add_problem(report_, error.context + " (byte " + std::to_string(place.offset) + ")");
  }

  std::unique_ptr<ByteSource> source_;
  rosbag1::Index index_;
  std::optional<std::int64_t> begin_ns_;
  std::int64_t end_ns_ = 0;
  std::vector<bool> wanted_;                ///< by topic
  std::vector<const ChunkPlace*> pending_;  ///< by first time
  std::size_t next_pending_ = 0;
  OpenChunks<OpenChunk> open_;
  BagReport report_;
};

void Rosbag1::start(std::vector<bool> wanted) {
  wanted_ = std::move(wanted);
  pending_.clear();
  for (const ChunkPlace& chunk : index_.chunks) pending_.push_back(&chunk);
  std::ranges::sort(pending_, {},
                    [](const ChunkPlace* place) { return std::tuple(place->first_ns, place->offset); });
  next_pending_ = 0;
  open_ = {};
  report_ = index_.report;
}

void Rosbag1::keep_selected(std::vector<MessagePlace>& messages, const ChunkPlace& place) {
  std::uint64_t unknown = 0;
  std::uint64_t misplaced = 0;
  std::erase_if(messages, [&](const MessagePlace& message) {
    const auto topic = index_.topic_of.find(message.connection);
    if (topic == index_.topic_of.end()) return ++unknown > 0;
    if (message.time_ns < place.first_ns || message.time_ns > place.last_ns) return ++misplaced > 0;
    return !wanted_[topic->second];
  });
  if (unknown > 0)
    rosbag1::add_problem(report_, std::to_string(unknown) + " messages belong to no connection");
  if (misplaced > 0)
    rosbag1::add_problem(report_,
                         std::to_string(misplaced) + " messages have other times than the index says");
  std::ranges::stable_sort(messages, {}, &MessagePlace::time_ns);
}

Status Rosbag1::open_chunk(const ChunkPlace& place) {
  auto chunk = std::make_unique<OpenChunk>();
  chunk->place = &place;
  EDGESPLAT_TRY(chunk->records, rosbag1::load_chunk(*source_, place.offset));
  EDGESPLAT_TRY(auto contents, rosbag1::list_chunk(chunk->records));
  chunk->messages = std::move(contents.messages);
  keep_selected(chunk->messages, place);
  if (chunk->messages.empty()) return {};
  open_.add(std::move(chunk));
  return {};
}

void Rosbag1::open_due_chunks() {
  while (next_pending_ < pending_.size()) {
    const ChunkPlace& place = *pending_[next_pending_];
    if (!open_.empty() && place.first_ns > std::get<0>(open_.front().key())) return;
    ++next_pending_;
    if (const Status opened = open_chunk(place); !opened) skip_chunk(place, opened.error());
    open_.give_back_memory();
  }
}

std::optional<BagMessage> Rosbag1::next() {
  open_.put_back_current();
  while (true) {
    open_due_chunks();
    if (open_.empty()) return std::nullopt;
    OpenChunk& chunk = open_.take_front();
    if (!chunk.records.empty()) break;
    const Status loaded = open_.restore_current(rosbag1::load_chunk(*source_, chunk.place->offset));
    if (loaded) break;
    skip_chunk(*chunk.place, loaded.error());
    open_.forget_current();
  }
  open_.give_back_memory();
  OpenChunk& current = open_.current();
  const MessagePlace& place = current.messages[current.next++];
  ++report_.messages_read;
  return BagMessage{index_.topic_of.at(place.connection), host_time_from_ns(place.time_ns),
                    std::span<const std::byte>(current.records).subspan(place.offset, place.bytes)};
}

Result<std::unique_ptr<BagSource>> open_source(std::unique_ptr<ByteSource> source) {
  EDGESPLAT_TRY(rosbag1::Index index, rosbag1::read_index(*source));
  return std::make_unique<Rosbag1>(std::move(source), std::move(index));
}

}  // namespace

Result<std::unique_ptr<BagSource>> open_rosbag1(const std::filesystem::path& path) {
  EDGESPLAT_TRY(auto source, open_byte_source(path));
  auto bag = open_source(std::move(source));
  if (!bag) return fail(bag.error().code, path.string() + ": " + bag.error().context);
  return bag;
}

Result<std::unique_ptr<BagSource>> rosbag1_from_bytes(std::span<const std::byte> bytes) {
  return open_source(make_byte_source(bytes));
}

}  // namespace edgesplat::io
