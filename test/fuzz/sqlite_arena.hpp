// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/check.hpp"

#include <sanitizer/asan_interface.h>
#include <sqlite3.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>

namespace edgesplat::fuzz {

/// SQLite's memory, one piece after the other, given back all at once: asking the sanitizer's allocator for
/// each of the thousand pieces that a statement takes costs more than all the rest. What is not allocated,
/// or no longer, is poisoned, so that reading what was given back is found as before, and nothing is
/// used twice within an input. One at a time, before anything else uses SQLite.
class SqliteArena {
 public:
  SqliteArena() {
    arena() = this;
    static const sqlite3_mem_methods kMethods{
        [](int bytes) { return arena()->allocate(bytes); },
        [](void* at) { arena()->release(at); },
        [](void* at, int bytes) { return arena()->reallocate(at, bytes); },
        [](void* at) { return static_cast<int>(size_of(at)); },
        [](int bytes) { return (bytes + 7) & ~7; },
        [](void*) { return SQLITE_OK; },
        [](void*) {},
        nullptr};
    ASAN_POISON_MEMORY_REGION(memory_.get(), kBytes);
    EDGESPLAT_CHECK(sqlite3_config(SQLITE_CONFIG_MALLOC, &kMethods) == SQLITE_OK &&
                        sqlite3_config(SQLITE_CONFIG_MEMSTATUS, 0) == SQLITE_OK &&
                        sqlite3_initialize() == SQLITE_OK,
                    "SQLite has not begun yet");
    sqlite3* db = nullptr;  // what the first one makes stays
    EDGESPLAT_CHECK(sqlite3_open(":memory:", &db) == SQLITE_OK, "SQLite starts");
    sqlite3_close(db);
    kept_ = used_;
  }
  SqliteArena(const SqliteArena&) = delete;
  SqliteArena& operator=(const SqliteArena&) = delete;

  /// Everything that was allocated since the beginning. Precondition: no database is open.
  void reset() {
    EDGESPLAT_CHECK(open_ == kept_open_ || kept_open_ < 0, "an input gives back what it takes");
    kept_open_ = open_;
    ASAN_POISON_MEMORY_REGION(memory_.get() + kept_, used_ - kept_);
    used_ = kept_;
  }

 private:
  static constexpr std::size_t kBytes = std::size_t{512} << 20U;
  static constexpr std::size_t kHeader = 16;  ///< the size, before the piece
  static constexpr std::size_t kGap = 16;     ///< poisoned, after it

  static SqliteArena*& arena() {
    static SqliteArena* one = nullptr;
    return one;
  }
  static std::size_t size_of(const void* at) {
    std::size_t bytes = 0;
    std::memcpy(&bytes, static_cast<const std::byte*>(at) - kHeader, sizeof(bytes));
    return bytes;
  }
  void* allocate(int wanted) {
    const std::size_t bytes = (static_cast<std::size_t>(wanted) + 7U) & ~std::size_t{7};
    const std::size_t whole = (kHeader + bytes + kGap + 15U) & ~std::size_t{15};
    if (whole > kBytes - used_) return nullptr;
    std::byte* at = memory_.get() + used_;
    used_ += whole;
    ++open_;
    ASAN_UNPOISON_MEMORY_REGION(at, kHeader + bytes);
    std::memcpy(at, &bytes, sizeof(bytes));
    return at + kHeader;
  }
  void release(void* at) {
    --open_;
    ASAN_POISON_MEMORY_REGION(at, size_of(at));
  }
  void* reallocate(void* at, int wanted) {
    const std::size_t had = size_of(at);
    if (static_cast<std::size_t>(wanted) <= had) return at;
    void* moved = allocate(wanted);
    if (moved == nullptr) return nullptr;
    std::memcpy(moved, at, had);
    release(at);
    return moved;
  }

  std::unique_ptr<std::byte[]> memory_{new std::byte[kBytes]};
  std::size_t used_ = 0;
  std::size_t kept_ = 0;
  std::int64_t open_ = 0;
  std::int64_t kept_open_ = -1;
};

}  // namespace edgesplat::fuzz
