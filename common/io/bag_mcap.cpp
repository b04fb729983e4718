// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/io/bag_mcap.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace edgesplat::io {
namespace {

class McapBag final : public BagSource {
 public:
  explicit McapBag(McapReader reader) : reader_(std::move(reader)) {
    for (const auto& [id, channel] : reader_.channels()) {
      const auto schema = reader_.schemas().find(channel.schema_id);
      if (schema == reader_.schemas().end()) continue;
      if (channel.message_encoding != "cdr" && channel.message_encoding != "ros1") continue;
      topic_of_.emplace(id, topics_.size());
      topics_.push_back({channel.topic, ros_type_name(schema->second.name),
                         channel.message_encoding == "ros1" ? RosEncoding::kRos1 : RosEncoding::kCdr});
    }
  }

  [[nodiscard]] const std::vector<BagTopic>& topics() const override { return topics_; }
  [[nodiscard]] HostTime begin() const override { return reader_.statistics().first_log_time; }
  [[nodiscard]] HostTime end() const override { return reader_.statistics().last_log_time; }
  void select(std::vector<std::size_t> topics) override {
    McapSelection selection;
    for (const std::size_t topic : topics) selection.topics.push_back(topics_.at(topic).name);
    reader_.select(std::move(selection));
    selected_ = std::move(topics);
  }
  [[nodiscard]] std::optional<BagMessage> next() override {
    if (selected_ && selected_->empty()) return std::nullopt;  // an empty selection of the reader means all
    while (const auto message = reader_.next()) {
      const auto topic = topic_of_.find(message->channel->id);
      if (topic == topic_of_.end()) continue;
      // Two channels may have one topic and different types.
      if (selected_ && std::find(selected_->begin(), selected_->end(), topic->second) == selected_->end())
        continue;
      return BagMessage{topic->second, message->log_time, message->payload};
    }
    return std::nullopt;
  }
  [[nodiscard]] BagReport report() const override {
    const McapReadReport& file = reader_.report();
    return {file.complete, file.messages_read, file.bytes_skipped, file.why};
  }

 private:
  McapReader reader_;
  std::vector<BagTopic> topics_;
  std::map<McapChannelId, std::size_t> topic_of_;
  std::optional<std::vector<std::size_t>> selected_;
};

}  // namespace

Result<std::unique_ptr<BagSource>> open_mcap_bag(const std::filesystem::path& path) {
  EDGESPLAT_TRY(McapReader reader, McapReader::open(path));
  return to_mcap_bag(std::move(reader));
}

std::unique_ptr<BagSource> to_mcap_bag(McapReader reader) {
  return std::make_unique<McapBag>(std::move(reader));
}

}  // namespace edgesplat::io
