// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/link/in_process_path.hpp"

#include <array>
#include <deque>
#include <mutex>
#include <utility>
#include <vector>

namespace edgesplat::link {
namespace {

struct Chunk {
  ChunkHeader header;
  std::vector<std::byte> payload;
};

/// One direction. Thread-safe.
class Pipe {
 public:
  Pipe(std::size_t limit, std::function<void()> wake) : limit_(limit), wake_(std::move(wake)) {}

  WriteOutcome write(Lane lane, const ChunkHeader& header, std::span<const std::byte> payload) {
    {
      const std::lock_guard lock(mutex_);
      if (!open_) return WriteOutcome::kRefused;
      auto& queue = lanes_[index_of(lane)];
      if (newest_only(lane) && !queue.empty()) queue.clear();
      if (queue.size() >= limit_) return WriteOutcome::kBusy;
      queue.push_back({header, {payload.begin(), payload.end()}});
      if (wake_) wake_();
    }
    return WriteOutcome::kWritten;
  }
  bool take(Lane lane, const ChunkHandler& handle) {
    Chunk chunk;
    {
      const std::lock_guard lock(mutex_);
      auto& queue = lanes_[index_of(lane)];
      if (queue.empty()) return false;
      chunk = std::move(queue.front());
      queue.pop_front();
    }
    handle(chunk.header, chunk.payload);
    return true;
  }
  /// The receiving end goes away.
  void close() {
    const std::lock_guard lock(mutex_);
    open_ = false;
    wake_ = {};
  }
  [[nodiscard]] bool open() const {
    const std::lock_guard lock(mutex_);
    return open_;
  }

 private:
  const std::size_t limit_;
  mutable std::mutex mutex_;
  std::function<void()> wake_;  ///< under the lock, so that close() ends its use
  std::array<std::deque<Chunk>, kLaneCount> lanes_;
  bool open_ = true;
};

class InProcessPath final : public ChunkPath {
 public:
  InProcessPath(Role role, std::shared_ptr<Pipe> out, std::shared_ptr<Pipe> in)
      : role_(role), out_(std::move(out)), in_(std::move(in)) {}
  ~InProcessPath() override { in_->close(); }

  WriteOutcome write(Lane lane, const ChunkHeader& header, std::span<const std::byte> payload) override {
    return out_->write(lane, header, payload);
  }
  bool take(Lane lane, const ChunkHandler& handle) override { return in_->take(lane, handle); }
  [[nodiscard]] bool has_reader(Lane lane) const override { return sends(role_, lane) && out_->open(); }

 private:
  const Role role_;
  const std::shared_ptr<Pipe> out_;
  const std::shared_ptr<Pipe> in_;
};

}  // namespace

InProcessPaths make_in_process_paths(std::size_t limit_chunks, std::function<void()> wake_robot,
                                     std::function<void()> wake_server) {
  auto up = std::make_shared<Pipe>(limit_chunks, std::move(wake_server));
  auto down = std::make_shared<Pipe>(limit_chunks, std::move(wake_robot));
  return {std::make_unique<InProcessPath>(Role::kRobot, up, down),
          std::make_unique<InProcessPath>(Role::kServer, down, up)};
}

}  // namespace edgesplat::link
