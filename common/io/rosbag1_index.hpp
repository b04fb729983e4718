// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/io/bag_source.hpp"
#include "common/io/rosbag1_records.hpp"

#include <cstdint>
#include <map>
#include <string_view>
#include <vector>

/// Inside common/io only.
namespace edgesplat::io::rosbag1 {

struct ChunkPlace {
  std::uint64_t offset = 0;
  std::int64_t first_ns = 0;
  std::int64_t last_ns = 0;
};

/// What is in a file.
struct Index {
  std::vector<BagTopic> topics;
  std::map<std::uint32_t, std::size_t> topic_of;  ///< connection -> index in topics
  std::vector<ChunkPlace> chunks;                 ///< in the order of the file
  BagReport report;
};

/// Says in the report that something is missing.
void add_problem(BagReport& report, std::string_view sentence);

/// From the index at the end, or, where it is missing or damaged, from every chunk (which are decompressed
/// for it): then the report says so where something was lost. kCorrupt where it is no bag of format 2.0.
[[nodiscard]] Result<Index> read_index(const ByteSource& source);

}  // namespace edgesplat::io::rosbag1
