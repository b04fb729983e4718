// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

namespace edgesplat::io {

/// The chunks of a recording that are being merged, the one with the earliest message in front. While more
/// than a budget is open, those whose next message is furthest away give their bytes back; take_front()'s
/// caller loads them again. A Chunk has `records` (its bytes; empty = given back), `records_bytes`,
/// `messages` by time, `next` among them, and key(), which orders chunks by that message. Single-owner.
template <typename Chunk>
class OpenChunks {
 public:
  [[nodiscard]] bool empty() const { return open_.empty(); }
  [[nodiscard]] const Chunk& front() const { return *open_.front(); }
  /// The one taken; it lends its bytes to the caller until it is put back.
  [[nodiscard]] Chunk& current() { return *current_; }

  void add(std::unique_ptr<Chunk> chunk) {
    chunk->records_bytes = chunk->records.size();
    bytes_ += chunk->records_bytes;
    push(std::move(chunk));
  }
  /// The front one becomes the current one; its bytes may have been given back.
  Chunk& take_front() {
    std::ranges::pop_heap(open_, is_later);
    current_ = std::move(open_.back());
    open_.pop_back();
    return *current_;
  }
  void put_back_current() {
    if (!current_) return;
    if (current_->next < current_->messages.size()) {
      push(std::move(current_));
    } else {
      bytes_ -= current_->records.size();
    }
    current_.reset();
  }
  /// The current one has its bytes again. Errors: those of reading, and kIo where there are not as many.
  [[nodiscard]] Status restore_current(Result<std::vector<std::byte>> records) {
    if (!records) return tl::unexpected(std::move(records).error());
    if (records->size() != current_->records_bytes)
      return fail(Errc::kIo, "the file changed while it was read");
    current_->records = *std::move(records);
    bytes_ += current_->records.size();
    return {};
  }
  /// The current one cannot be read any more; it holds no bytes.
  void forget_current() { current_.reset(); }
  /// All but one of those that wait may lose their bytes.
  void give_back_memory() {
    while (bytes_ > kBytesBudget) {
      Chunk* furthest = nullptr;
      std::size_t loaded = 0;
      for (const auto& chunk : open_) {
        if (chunk->records.empty()) continue;
        ++loaded;
        if (furthest == nullptr || chunk->key() >= furthest->key()) furthest = chunk.get();
      }
      if (loaded <= 1) return;
      bytes_ -= furthest->records.size();
      furthest->records = {};
    }
  }

 private:
  static constexpr std::size_t kBytesBudget = std::size_t{64} << 20U;
  static bool is_later(const std::unique_ptr<Chunk>& a, const std::unique_ptr<Chunk>& b) {
    return a->key() > b->key();
  }
  void push(std::unique_ptr<Chunk> chunk) {
    open_.push_back(std::move(chunk));
    std::ranges::push_heap(open_, is_later);
  }

  std::vector<std::unique_ptr<Chunk>> open_;  ///< heap
  std::unique_ptr<Chunk> current_;
  std::size_t bytes_ = 0;
};

}  // namespace edgesplat::io
