// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/time/time.hpp"

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace edgesplat::replay {

/// The lines of a times.txt: seconds, one a line, rising. kInvalidConfig with file:line.
[[nodiscard]] Result<std::vector<nanoseconds>> parse_times(std::string_view text, std::string_view file_name);

/// When each numbered file of a folder was measured. A file's number is its stem (`0000000042` -> 42); where
/// a stem is no number, its place in the sorted list. Without times: 10 Hz.
class FrameTimes {
 public:
  /// `times`: what times.txt says, or nothing. `stems`: of the scans, sorted. A line belongs to the file with
  /// its number (first line: 0), or, where numbers run past the lines, to the file at its place.
  /// kInvalidArgument where neither fits.
  static Result<FrameTimes> create(std::optional<std::vector<nanoseconds>> times,
                                   const std::vector<std::string>& stems);
  /// Nothing for a file without a scan number or a line.
  [[nodiscard]] std::optional<nanoseconds> of(const std::string& stem) const;

 private:
  [[nodiscard]] std::optional<std::uint64_t> number_of(const std::string& stem) const;

  std::optional<std::vector<nanoseconds>> times_;
  bool by_place_ = false;
  std::uint64_t first_number_ = 0;
  std::map<std::string, std::uint64_t, std::less<>> places_;
};

}  // namespace edgesplat::replay
