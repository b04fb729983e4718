// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

namespace edgesplat::livox {

/// A moment as Livox SDK1 writes it on the wire.
struct UtcDate {
  int year = 2000;
  int month = 1;  ///< 1..12
  int day = 1;    ///< 1..31
  int hour = 0;   ///< 0..23
  std::uint32_t microsecond_of_hour = 0;

  bool operator==(const UtcDate&) const = default;
};

/// ns since 1970 (UTC, without leap seconds); nothing where the date does not exist. Years 1970 to 2261.
[[nodiscard]] std::optional<std::int64_t> to_unix_ns(const UtcDate& date);
/// The reverse, cut down to whole us.
[[nodiscard]] UtcDate to_utc_date(std::int64_t unix_ns);

}  // namespace edgesplat::livox
