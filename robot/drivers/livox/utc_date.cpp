// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/drivers/livox/utc_date.hpp"

#include <chrono>

namespace edgesplat::livox {
namespace {

constexpr std::uint32_t kMicrosecondsPerHour = 3'600'000'000U;
constexpr int kFirstYear = 1970;
constexpr int kLastYear = 2261;  // 2^63 ns end in 2262

}  // namespace

std::optional<std::int64_t> to_unix_ns(const UtcDate& date) {
  using std::chrono::year_month_day, std::chrono::year, std::chrono::month, std::chrono::day;
  if (date.year < kFirstYear || date.year > kLastYear || date.month < 1 || date.day < 1) return std::nullopt;
  const year_month_day calendar(year(date.year), month(static_cast<unsigned>(date.month)),
                                day(static_cast<unsigned>(date.day)));
  const bool exists =
      calendar.ok() && date.hour >= 0 && date.hour < 24 && date.microsecond_of_hour < kMicrosecondsPerHour;
  if (!exists) return std::nullopt;
  const auto moment = std::chrono::sys_days(calendar) + std::chrono::hours(date.hour) +
                      std::chrono::microseconds(date.microsecond_of_hour);
  return std::chrono::nanoseconds(moment.time_since_epoch()).count();
}

UtcDate to_utc_date(std::int64_t unix_ns) {
  const std::chrono::sys_time<std::chrono::nanoseconds> moment{std::chrono::nanoseconds(unix_ns)};
  const auto midnight = std::chrono::floor<std::chrono::days>(moment);
  const std::chrono::year_month_day calendar(midnight);
  const auto hour = std::chrono::floor<std::chrono::hours>(moment - midnight);
  UtcDate date;
  date.year = static_cast<int>(calendar.year());
  date.month = static_cast<int>(static_cast<unsigned>(calendar.month()));
  date.day = static_cast<int>(static_cast<unsigned>(calendar.day()));
  date.hour = static_cast<int>(hour.count());
  date.microsecond_of_hour = static_cast<std::uint32_t>(
      std::chrono::floor<std::chrono::microseconds>(moment - midnight - hour).count());
  return date;
}

}  // namespace edgesplat::livox
