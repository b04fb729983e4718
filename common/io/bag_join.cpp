// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/io/bag_join.hpp"

#include <algorithm>
#include <utility>

namespace edgesplat::io {
namespace {

class JoinedBag final : public BagSource {
 public:
  explicit JoinedBag(std::vector<std::unique_ptr<BagSource>> parts) {
    std::stable_sort(parts.begin(), parts.end(),
                     [](const auto& a, const auto& b) { return a->begin() < b->begin(); });
    for (auto& source : parts) add(std::move(source));
  }

  [[nodiscard]] const std::vector<BagTopic>& topics() const override { return topics_; }
  [[nodiscard]] HostTime begin() const override { return begin_; }
  [[nodiscard]] HostTime end() const override { return end_; }
  void select(std::vector<std::size_t> topics) override;
  [[nodiscard]] std::optional<BagMessage> next() override;
  [[nodiscard]] BagReport report() const override;

 private:
  struct Part {
    std::unique_ptr<BagSource> source;
    std::vector<std::size_t> topic_of;  ///< the file's topic -> ours
    bool started = false;
    std::optional<BagMessage> waiting;  ///< the next one of this file
  };
  void add(std::unique_ptr<BagSource> source);
  [[nodiscard]] std::size_t index_of(const BagTopic& topic);

  std::vector<Part> parts_;  ///< by begin
  std::vector<BagTopic> topics_;
  HostTime begin_{};
  HostTime end_{};
  Part* lent_ = nullptr;  ///< the caller holds its message
};

std::size_t JoinedBag::index_of(const BagTopic& topic) {
  const auto same = [&](const BagTopic& other) {
    return other.name == topic.name && other.type == topic.type && other.encoding == topic.encoding;
  };
  const auto place = std::find_if(topics_.begin(), topics_.end(), same);
  const auto index = static_cast<std::size_t>(place - topics_.begin());
  if (place == topics_.end()) topics_.push_back(topic);
  return index;
}

void JoinedBag::add(std::unique_ptr<BagSource> source) {
  Part part;
  for (const BagTopic& topic : source->topics()) part.topic_of.push_back(index_of(topic));
  if (source->end() != HostTime{}) {
    begin_ = end_ == HostTime{} ? source->begin() : std::min(begin_, source->begin());
    end_ = std::max(end_, source->end());
  }
  part.source = std::move(source);
  parts_.push_back(std::move(part));
}

void JoinedBag::select(std::vector<std::size_t> topics) {
  lent_ = nullptr;
  for (Part& part : parts_) {
    std::vector<std::size_t> wanted;
    for (std::size_t i = 0; i < part.topic_of.size(); ++i)
      if (std::find(topics.begin(), topics.end(), part.topic_of[i]) != topics.end()) wanted.push_back(i);
    part.source->select(std::move(wanted));
    part.started = false;
    part.waiting.reset();
  }
}

std::optional<BagMessage> JoinedBag::next() {
  if (lent_ != nullptr) lent_->waiting = lent_->source->next();
  lent_ = nullptr;
  for (Part& part : parts_) {
    if (!part.started && (lent_ == nullptr || part.source->begin() <= lent_->waiting->time)) {
      part.started = true;
      part.waiting = part.source->next();
    }
    if (part.waiting && (lent_ == nullptr || part.waiting->time < lent_->waiting->time)) lent_ = &part;
  }
  if (lent_ == nullptr) return std::nullopt;
  BagMessage message = *lent_->waiting;
  message.topic = lent_->topic_of[message.topic];
  return message;
}

BagReport JoinedBag::report() const {
  BagReport all;
  for (const Part& part : parts_) {
    const BagReport one = part.source->report();
    all.complete = all.complete && one.complete;
    all.messages_read += one.messages_read;
    all.bytes_skipped += one.bytes_skipped;
    if (!one.why.empty()) all.why += (all.why.empty() ? "" : "; ") + one.why;
  }
  return all;
}

}  // namespace

std::unique_ptr<BagSource> join_bags(std::vector<std::unique_ptr<BagSource>> parts) {
  return std::make_unique<JoinedBag>(std::move(parts));
}

}  // namespace edgesplat::io
