// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/base/check.hpp"
#include "common/io/mcap_reader.hpp"

#include <cstddef>
#include <cstdint>

/// Reads everything of a recording; messages must come in order, and losses must be told.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* first, std::size_t size) {
  using namespace edgesplat;
  auto reader = io::McapReader::from_bytes(std::as_bytes(std::span(first, size)));
  if (!reader) return 0;
  HostTime last = HostTime::min();
  std::uint64_t payload_bytes = 0;
  while (const auto message = reader->next()) {
    EDGESPLAT_CHECK(message->log_time >= last, "messages must not go back in time");
    last = message->log_time;
    for (const auto byte : message->payload) payload_bytes += static_cast<std::uint64_t>(byte);
  }
  (void)payload_bytes;
  for (const auto& name : reader->attachment_names()) (void)reader->attachment(name);
  (void)reader->metadata();
  EDGESPLAT_CHECK(reader->report().complete == reader->report().why.empty(), "a loss must be explained");
  return 0;
}
