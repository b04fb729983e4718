// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/sync/ptp_report.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace edgesplat::sync {
namespace {

constexpr std::size_t kMostPorts = 256;
constexpr std::string_view kBlank = " \t\r";

/// The next word of a line; empty at its end.
std::string_view take_word(std::string_view& line) {
  const auto begin = line.find_first_not_of(kBlank);
  if (begin == std::string_view::npos) return line = {};
  const auto end = std::min(line.find_first_of(kBlank, begin), line.size());
  const std::string_view word = line.substr(begin, end - begin);
  line.remove_prefix(end);
  return word;
}

std::string_view take_line(std::string_view& text) {
  const auto end = std::min(text.find('\n'), text.size());
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(std::min(end + 1, text.size()));
  return line;
}

std::optional<double> number(std::string_view word) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::optional<std::int64_t> whole(std::string_view word) {
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size()) return std::nullopt;
  return value;
}

std::optional<bool> truth(std::string_view word) {
  if (word == "true") return true;
  if (word == "false") return false;
  return std::nullopt;
}

/// "000000.fffe.000000-1 seq 3 RESPONSE MANAGEMENT PORT_DATA_SET": which data set the lines below are of;
/// nothing for other lines, empty for an answer that is no response (an error).
std::optional<std::string_view> data_set_of(std::string_view line) {
  (void)take_word(line);
  if (take_word(line) != "seq") return std::nullopt;
  (void)take_word(line);
  if (take_word(line) != "RESPONSE" || take_word(line) != "MANAGEMENT") return std::string_view();
  return take_word(line);
}

void take_field(std::string_view data_set, std::string_view name, std::string_view value, PtpReport& report) {
  if (data_set == "PORT_DATA_SET") {
    if (name == "portIdentity" && report.ports.size() < kMostPorts)
      report.ports.push_back({std::string(value), {}});
    if (name == "portState" && !report.ports.empty()) report.ports.back().state = value;
  } else if (data_set == "CURRENT_DATA_SET") {
    if (name == "offsetFromMaster") report.offset_from_master_ns = number(value);
    if (name == "meanPathDelay") report.mean_path_delay_ns = number(value);
    if (name == "stepsRemoved") report.steps_removed = whole(value);
  } else if (data_set == "TIME_STATUS_NP") {
    if (name == "gmPresent") report.grandmaster_present = truth(value);
    if (name == "gmIdentity") report.grandmaster = value;
  }
}

}  // namespace

bool PtpReport::has_port_in(std::string_view state) const {
  return std::ranges::any_of(ports, [state](const PtpPort& port) { return port.state == state; });
}

Result<PtpReport> parse_pmc(std::string_view text) {
  PtpReport report;
  std::string_view data_set;
  while (!text.empty()) {
    std::string_view line = take_line(text);
    if (const auto begun = data_set_of(line)) {
      data_set = *begun;
      continue;
    }
    const std::string_view name = take_word(line);
    const std::string_view value = take_word(line);
    if (!value.empty()) take_field(data_set, name, value, report);
  }
  if (report.ports.empty())
    return fail(Errc::kUnavailable, "pmc told of no PTP port: does ptp4l run, and may this user talk to it?");
  return report;
}

}  // namespace edgesplat::sync
