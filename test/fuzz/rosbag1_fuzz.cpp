// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/base/check.hpp"
#include "common/io/rosbag1.hpp"

#include <cstddef>
#include <cstdint>

/// Reads everything of a bag twice; messages must come in order, and losses must be told.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* first, std::size_t size) {
  using namespace edgesplat;
  auto bag = io::rosbag1_from_bytes(std::as_bytes(std::span(first, size)));
  if (!bag) return 0;
  std::uint64_t payload_bytes = 0;
  for (int pass = 0; pass < 2; ++pass) {
    HostTime last = HostTime::min();
    while (const auto message = (*bag)->next()) {
      EDGESPLAT_CHECK(message->time >= last, "messages must not go back in time");
      EDGESPLAT_CHECK(message->topic < (*bag)->topics().size(), "a message must have a topic");
      last = message->time;
      for (const auto byte : message->payload) payload_bytes += static_cast<std::uint64_t>(byte);
    }
    EDGESPLAT_CHECK((*bag)->report().complete == (*bag)->report().why.empty(), "a loss must be explained");
    if (!(*bag)->topics().empty()) (*bag)->select({0});
  }
  (void)payload_bytes;
  return 0;
}
