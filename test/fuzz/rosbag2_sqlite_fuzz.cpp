// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/base/check.hpp"
#include "common/io/rosbag2_sqlite.hpp"
#include "test/fuzz/sqlite_arena.hpp"

#include <cstddef>
#include <cstdint>

namespace {

/// Reads up to 10 000 messages of a database; losses must be told.
void read_all(std::span<const std::byte> bytes) {
  using namespace edgesplat;
  auto bag = io::rosbag2_sqlite_from_bytes(bytes);
  if (!bag) return;
  std::uint64_t payload_bytes = 0;
  for (int count = 0; count < 10'000; ++count) {
    const auto message = (*bag)->next();
    if (!message) break;
    EDGESPLAT_CHECK(message->topic < (*bag)->topics().size(), "a message must have a topic");
    for (const auto byte : message->payload) payload_bytes += static_cast<std::uint64_t>(byte);
  }
  (void)payload_bytes;
  EDGESPLAT_CHECK((*bag)->report().complete == (*bag)->report().why.empty(), "a loss must be explained");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* first, std::size_t size) {
  static edgesplat::fuzz::SqliteArena arena;
  read_all(std::as_bytes(std::span(first, size)));
  arena.reset();
  return 0;
}
