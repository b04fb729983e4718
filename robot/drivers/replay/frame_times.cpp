// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/drivers/replay/frame_times.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace edgesplat::replay {
namespace {

constexpr nanoseconds kPeriod = std::chrono::milliseconds(100);
constexpr double kLongest_s = 1e8;  // three years: beyond it is no recording
constexpr std::uint64_t kLargestNumber = 1'000'000'000;

std::optional<std::uint64_t> parse_number(std::string_view stem) {
  std::uint64_t number = 0;
  const auto [rest, error] = std::from_chars(stem.data(), stem.data() + stem.size(), number);
  if (error != std::errc{} || rest != stem.data() + stem.size() || number > kLargestNumber)
    return std::nullopt;
  return number;
}

std::string_view trimmed(std::string_view row) {
  const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  while (!row.empty() && blank(row.front())) row.remove_prefix(1);
  while (!row.empty() && blank(row.back())) row.remove_suffix(1);
  return row;
}

}  // namespace

Result<std::vector<nanoseconds>> parse_times(std::string_view text, std::string_view file_name) {
  std::vector<nanoseconds> times;
  for (std::size_t line = 1; !text.empty(); ++line) {
    const std::string_view row = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(text.size(), row.size() + 1));
    const std::string_view number = trimmed(row);
    if (number.empty()) continue;
    double seconds = 0;
    const auto [rest, error] = std::from_chars(number.data(), number.data() + number.size(), seconds);
    const bool usable = error == std::errc{} && rest == number.data() + number.size() &&
                        std::isfinite(seconds) && seconds >= 0 && seconds < kLongest_s;
    if (!usable || (!times.empty() && from_seconds(seconds) <= times.back()))
      return fail(Errc::kInvalidConfig, std::string(file_name) + ":" + std::to_string(line) +
                                            ": expected one time in seconds, later than the line before");
    times.push_back(from_seconds(seconds));
  }
  return times;
}

Result<FrameTimes> FrameTimes::create(std::optional<std::vector<nanoseconds>> times,
                                      const std::vector<std::string>& stems) {
  FrameTimes result;
  std::uint64_t largest = 0;
  bool numbered = true;
  for (const std::string& stem : stems) {
    result.places_.emplace(stem, result.places_.size());
    const auto number = parse_number(stem);
    numbered = numbered && number.has_value();
    largest = std::max(largest, number.value_or(0));
  }
  result.by_place_ = !numbered;
  if (times) {
    if (numbered && largest < times->size()) {
      result.by_place_ = false;
    } else if (times->size() == stems.size()) {
      result.by_place_ = true;
    } else {
      return fail(
          Errc::kInvalidArgument,
          "times.txt has " + std::to_string(times->size()) + " lines for " + std::to_string(stems.size()) +
              " scans; give one line a scan, or one line for each number up to " + std::to_string(largest));
    }
  } else if (!stems.empty() && numbered) {
    result.first_number_ = *parse_number(stems.front());
    for (const std::string& stem : stems)
      result.first_number_ = std::min(result.first_number_, *parse_number(stem));
  }
  result.times_ = std::move(times);
  return result;
}

std::optional<std::uint64_t> FrameTimes::number_of(const std::string& stem) const {
  if (!by_place_) return parse_number(stem);
  const auto place = places_.find(stem);
  if (place == places_.end()) return std::nullopt;
  return place->second;
}

std::optional<nanoseconds> FrameTimes::of(const std::string& stem) const {
  const auto number = number_of(stem);
  if (!number || *number < first_number_) return std::nullopt;
  if (!times_) return kPeriod * static_cast<std::int64_t>(*number - first_number_);
  if (*number >= times_->size()) return std::nullopt;
  return (*times_)[static_cast<std::size_t>(*number)];
}

}  // namespace edgesplat::replay
