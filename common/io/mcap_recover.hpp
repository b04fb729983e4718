// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/io/mcap_types.hpp"

#include <cstdint>
#include <filesystem>
#include <string>

namespace edgesplat::io {

/// What became of a recording that was cut short.
struct McapRecovery {
  bool was_whole = false;  ///< it had its end: nothing was changed
  McapStatistics statistics;
  std::uint64_t bytes_cut = 0;       ///< of records that were not whole, at the end
  std::uint64_t chunks_skipped = 0;  ///< damaged ones in between: they stay where they are, unread
  std::string why;                   ///< what was wrong; empty where was_whole
};

/// Gives a file that its writer could not close (killed, power cut) the end it lacks, in place: cuts off what
/// is not whole and writes the indexes and the summary, so that every MCAP reader can seek in it. Nothing
/// that can be read is lost, also when it is interrupted itself. Reads the whole file once. kNotFound, kIo;
/// kCorrupt where it is no MCAP file or has nothing to keep; kInvalidArgument for messages outside chunks,
/// which McapWriter never writes; kUnavailable while a McapWriter has it open.
[[nodiscard]] Result<McapRecovery> recover_mcap(const std::filesystem::path& path);

}  // namespace edgesplat::io
