// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/virtual_device/lidar_fault.hpp"

#include <arpa/inet.h>

#include <algorithm>
#include <charconv>
#include <cstring>
#include <optional>
#include <string>

namespace edgesplat::virtual_device {
namespace {

using Kind = LidarFault::Kind;

struct Spelling {
  std::string_view name;
  Kind kind;
  bool lasts;
  bool has_value;
};
constexpr std::array kSpellings{Spelling{"silence", Kind::kSilence, true, false},
                                Spelling{"reboot", Kind::kReboot, true, false},
                                Spelling{"address", Kind::kAddress, true, true},
                                Spelling{"loss", Kind::kLoss, true, true},
                                Spelling{"stuck-sync", Kind::kStuckSync, false, false},
                                Spelling{"clock-step", Kind::kClockStep, false, true}};

/// What stands before `mark`; the rest, with it, stays in `text`.
std::string_view until(std::string_view& text, std::string_view marks) {
  const std::string_view part = text.substr(0, text.find_first_of(marks));
  text.remove_prefix(part.size());
  return part;
}

std::optional<double> number(std::string_view text) {
  double value = 0.0;
  const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || rest != text.data() + text.size() || !(value >= -3600.0 && value <= 36000.0))
    return std::nullopt;
  return value;
}

/// The number after `mark`, if the text goes on with it.
bool take(std::string_view& text, char mark, double& value) {
  if (!text.starts_with(mark)) return false;
  text.remove_prefix(1);
  const auto parsed = number(until(text, "@+="));
  value = parsed.value_or(0.0);
  return parsed.has_value();
}

}  // namespace

Result<std::array<std::uint8_t, 4>> parse_address(const std::string& text) {
  in_addr parsed{};
  if (::inet_pton(AF_INET, text.c_str(), &parsed) != 1)
    return fail(Errc::kInvalidConfig, "'" + text + "' is no IPv4 address such as 127.0.0.9");
  std::array<std::uint8_t, 4> address{};
  std::memcpy(address.data(), &parsed, address.size());
  return address;
}

Result<LidarFault> parse_lidar_fault(std::string_view text) {
  const std::string whole(text);
  const std::string_view name = until(text, "@+=");
  for (const Spelling& spelling : kSpellings) {
    if (spelling.name != name) continue;
    LidarFault fault;
    fault.kind = spelling.kind;
    bool good = take(text, '@', fault.at_s) && fault.at_s >= 0.0;
    if (spelling.lasts) good = good && take(text, '+', fault.lasts_s) && fault.lasts_s >= 0.0;
    if (spelling.kind == Kind::kAddress) {
      const auto address = parse_address(std::string(text.substr(std::min<std::size_t>(1, text.size()))));
      good = good && text.starts_with('=') && address.has_value();
      if (address) fault.address = *address;
      text = {};
    } else if (spelling.has_value) {
      good = good && take(text, '=', fault.value);
    }
    if (spelling.kind == Kind::kLoss) good = good && fault.value >= 0.0 && fault.value <= 1.0;
    if (good && text.empty()) return fault;
  }
  return fail(
      Errc::kInvalidConfig,
      "no fault of a LiDAR: '" + whole +
          "'; such are silence@3+2, reboot@5+1.5, address@8+1=127.0.0.9, loss@10+5=0.05, stuck-sync@12 "
          "and clock-step@12=0.2 (at@, lasting+, in seconds of the recording)");
}

}  // namespace edgesplat::virtual_device
