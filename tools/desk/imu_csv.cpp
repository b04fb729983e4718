// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/desk/imu_csv.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>
#include <optional>
#include <string>

namespace edgesplat::desk {
namespace {

constexpr std::string_view kBlank = " \t\r";

std::string_view trim(std::string_view text) {
  const auto first = text.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

/// Everything before `separator`, which leaves `rest` together with it.
std::string_view take_until(std::string_view& rest, char separator) {
  const auto end = rest.find(separator);
  const std::string_view part = rest.substr(0, end);
  rest = end == std::string_view::npos ? std::string_view{} : rest.substr(end + 1);
  return part;
}

template <typename Number>
std::optional<Number> parse_number(std::string_view text) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

std::optional<SensorTime> parse_stamp(std::string_view text) {
  if (const auto whole = parse_number<std::int64_t>(text)) return sensor_time_from_ns(*whole);
  const auto decimal = parse_number<double>(text);
  constexpr double kMost_ns = 9.2e18;  // what int64 holds
  if (!decimal || !(std::abs(*decimal) < kMost_ns)) return std::nullopt;
  return sensor_time_from_ns(static_cast<std::int64_t>(*decimal));
}

std::optional<sensor::ImuSample> parse_row(std::string_view row) {
  sensor::ImuSample sample;
  const auto stamp = parse_stamp(trim(take_until(row, ',')));
  if (!stamp) return std::nullopt;
  sample.stamp = *stamp;
  sample.arrival = host_time_from_ns(to_ns(*stamp));
  sample.stamp_source = sensor::StampSource::kPtp;
  std::array<double, 6> values{};
  for (double& value : values) {
    const auto number = parse_number<double>(trim(take_until(row, ',')));
    if (!number || !std::isfinite(*number)) return std::nullopt;
    value = *number;
  }
  if (!trim(row).empty()) return std::nullopt;
  sample.gyro_radps = {values[0], values[1], values[2]};
  sample.accel_mps2 = {values[3], values[4], values[5]};
  return sample;
}

/// "1403636763.853,,,,,,": what a spreadsheet leaves of a row without a measurement.
bool has_no_values(std::string_view row) {
  const auto comma = row.find(',');
  return comma != std::string_view::npos && row.find_first_not_of(", \t", comma) == std::string_view::npos;
}

}  // namespace

Result<std::vector<sensor::ImuSample>> parse_imu_csv(std::string_view text, std::string_view name) {
  std::vector<sensor::ImuSample> samples;
  for (int line = 1; !text.empty(); ++line) {
    const std::string_view row = trim(take_until(text, '\n'));
    if (row.empty() || row.front() == '#' || has_no_values(row)) continue;
    const auto sample = parse_row(row);
    if (!sample) {
      return fail(
          Errc::kCorrupt,
          fmt::format("{}:{}: expected seven numbers: t_ns, gyro x y z (rad/s), accelerometer x y z (m/s^2)",
                      name, line));
    }
    if (!samples.empty() && sample->stamp <= samples.back().stamp) {
      return fail(Errc::kCorrupt,
                  fmt::format("{}:{}: the stamp does not rise: sort the rows by time", name, line));
    }
    samples.push_back(*sample);
  }
  return samples;
}

Result<std::vector<sensor::ImuSample>> read_imu_csv(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return fail(Errc::kNotFound, "cannot open " + path.string() + ": is it a readable file?");
  const std::string text(std::istreambuf_iterator<char>(file), {});
  if (file.bad()) return fail(Errc::kIo, "cannot read " + path.string());
  return parse_imu_csv(text, path.string());
}

}  // namespace edgesplat::desk
