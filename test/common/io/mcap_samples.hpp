// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/io/atomic_file.hpp"
#include "common/io/mcap_reader.hpp"
#include "common/io/mcap_writer.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <numeric>
#include <string>
#include <vector>

namespace edgesplat::io {

inline std::span<const std::byte> bytes_of(std::string_view text) {
  return std::as_bytes(std::span(text.data(), text.size()));
}

/// Text payload of the numbered message that write_sample() writes.
inline std::string sample_payload(int number) {
  return "message " + std::to_string(number) + std::string(static_cast<std::size_t>(number % 50), '.');
}

/// `count` messages, one each 10 ms, in turn on /even and /odd.
inline McapWriter start_sample(const std::filesystem::path& path, int count, McapWriterOptions options) {
  auto writer = McapWriter::create(path, std::move(options));
  EXPECT_TRUE(writer) << writer.error().context;
  const auto schema = writer->add_schema("test/msg/Text", "ros2msg", "string text\n").value();
  const auto even = writer->add_channel("/even", schema, "cdr", {{"side", "left"}}).value();
  const auto odd = writer->add_channel("/odd", schema).value();
  for (int i = 0; i < count; ++i) {
    const std::int64_t time_ns = std::int64_t{i} * 10'000'000;
    const auto written =
        writer->write(i % 2 == 0 ? even : odd, static_cast<std::uint32_t>(i), host_time_from_ns(time_ns),
                      sensor_time_from_ns(time_ns - 5), bytes_of(sample_payload(i)));
    EXPECT_TRUE(written);
  }
  return std::move(*writer);
}

inline std::vector<std::byte> make_sample(const std::filesystem::path& path, int count,
                                          McapWriterOptions options = {}) {
  auto writer = start_sample(path, count, std::move(options));
  EXPECT_TRUE(writer.close());
  return read_file(path, 1U << 30U).value();
}

/// Sequence numbers in the order read; checks each payload and that time does not go back.
inline std::vector<int> read_sample(McapReader& reader) {
  std::vector<int> sequence;
  HostTime last = HostTime::min();
  while (const auto message = reader.next()) {
    const int number = static_cast<int>(message->sequence);
    sequence.push_back(number);
    EXPECT_TRUE(std::ranges::equal(message->payload, bytes_of(sample_payload(number))));
    EXPECT_GE(message->log_time, last);
    last = message->log_time;
  }
  EXPECT_EQ(reader.report().messages_read, sequence.size());
  EXPECT_EQ(reader.report().why.empty(), reader.report().complete);
  return sequence;
}

inline std::vector<int> count_up_to(int count) {
  std::vector<int> numbers(static_cast<std::size_t>(count));
  std::iota(numbers.begin(), numbers.end(), 0);
  return numbers;
}

}  // namespace edgesplat::io
