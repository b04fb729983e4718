// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/io/trajectory_file.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cstdint>
#include <limits>

namespace edgesplat::io {
namespace {

constexpr int kNsDecimals = 9;

/// Digits of a decimal number: value = digits * 10^exponent, digits without the point.
struct Decimal {
  bool negative = false;
  std::string digits;
  int exponent = 0;
};

bool is_digit(char letter) {
  return letter >= '0' && letter <= '9';
}

std::optional<Decimal> split_decimal(std::string_view text) {
  Decimal decimal;
  if (!text.empty() && (text.front() == '-' || text.front() == '+')) {
    decimal.negative = text.front() == '-';
    text.remove_prefix(1);
  }
  bool after_point = false;
  std::size_t used = 0;
  for (; used < text.size(); ++used) {
    const char letter = text[used];
    if (letter == '.' && !after_point) {
      after_point = true;
    } else if (is_digit(letter)) {
      if (after_point) --decimal.exponent;
      if (letter != '0' || !decimal.digits.empty()) decimal.digits += letter;
    } else {
      break;
    }
  }
  if (used == (after_point ? 1U : 0U)) return std::nullopt;  // no digit at all
  text.remove_prefix(used);
  if (text.empty()) return decimal;
  if (text.front() != 'e' && text.front() != 'E') return std::nullopt;
  text.remove_prefix(1);
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  int exponent = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), exponent);
  constexpr int kLargestExponent = 1000;
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  if (exponent > kLargestExponent || exponent < -kLargestExponent) return std::nullopt;
  decimal.exponent += exponent;
  return decimal;
}

}  // namespace

std::optional<HostTime> parse_decimal_seconds(std::string_view text) {
  const auto decimal = split_decimal(text);
  if (!decimal) return std::nullopt;
  // Digits that count whole nanoseconds; the first one after them rounds, half away from zero.
  const auto& digits = decimal->digits;
  if (digits.empty()) return HostTime{};
  const auto whole_digits = static_cast<std::ptrdiff_t>(digits.size()) + decimal->exponent + kNsDecimals;
  constexpr std::uint64_t kMax = std::numeric_limits<std::int64_t>::max();
  std::uint64_t time_ns = 0;
  for (std::ptrdiff_t i = 0; i < whole_digits; ++i) {
    const auto place = static_cast<std::size_t>(i);
    const auto digit = static_cast<std::uint64_t>(place < digits.size() ? digits[place] - '0' : 0);
    if (time_ns > (kMax - digit) / 10) return std::nullopt;
    time_ns = time_ns * 10 + digit;
  }
  const bool has_next = whole_digits >= 0 && static_cast<std::size_t>(whole_digits) < digits.size();
  if (has_next && digits[static_cast<std::size_t>(whole_digits)] >= '5') ++time_ns;
  if (time_ns > kMax) return std::nullopt;
  const auto signed_ns = static_cast<std::int64_t>(time_ns);
  return host_time_from_ns(decimal->negative ? -signed_ns : signed_ns);
}

std::string format_decimal_seconds(HostTime stamp) {
  constexpr std::uint64_t kNsPerSecond = 1'000'000'000;
  const std::int64_t time_ns = to_ns(stamp);
  // The magnitude of the most negative number fits only without a sign.
  const auto magnitude = time_ns < 0 ? std::uint64_t{0} - static_cast<std::uint64_t>(time_ns)
                                     : static_cast<std::uint64_t>(time_ns);
  return fmt::format("{}{}.{:09}", time_ns < 0 ? "-" : "", magnitude / kNsPerSecond,
                     magnitude % kNsPerSecond);
}

}  // namespace edgesplat::io
