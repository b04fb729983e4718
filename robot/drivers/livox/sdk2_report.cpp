// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/drivers/livox/sdk2_report.hpp"

#include "common/base/bytes.hpp"

namespace edgesplat::livox {
namespace {

/// Nothing where the value is too short.
template <typename T>
std::optional<T> number(std::span<const std::byte> value) {
  ByteReader reader(value);
  const T read = reader.read<T>();
  return reader.ok() ? std::optional<T>(read) : std::nullopt;
}

std::string sync_name(std::uint8_t type) {
  if (type == 1) return "ptp";
  return type == 2 ? "gps" : "none";
}

std::string fault_codes(std::span<const std::byte> value) {
  std::string codes;
  ByteReader reader(value);
  while (reader.remaining() >= sizeof(std::uint32_t)) {
    const auto code = reader.read<std::uint32_t>();
    if (code != 0) codes += (codes.empty() ? "" : " ") + std::to_string(code);
  }
  return codes;
}

}  // namespace

Sdk2Report read_report(std::span<const KeyValue> values) {
  constexpr double kDegreesPerStep = 0.01;
  Sdk2Report report;
  for (const auto& [key, value] : values) {
    if (key == Key::kSerialNumber) report.serial_number = read_serial_number(value);
    if (key == Key::kFirmwareType) report.firmware_type = number<std::uint8_t>(value);
    if (key == Key::kWorkState) report.work_state = number<std::uint8_t>(value);
    if (key == Key::kWorkMode) report.work_mode = number<std::uint8_t>(value);
    if (key == Key::kTimeOffset) report.time_offset_ns = number<std::int64_t>(value);
    if (key == Key::kFaultCodes) report.faults = fault_codes(value);
    if (key == Key::kCoreTemperature) {
      if (const auto steps = number<std::int32_t>(value))
        report.core_temperature_deg = kDegreesPerStep * *steps;
    }
    if (key == Key::kSyncType) {
      if (const auto type = number<std::uint8_t>(value)) report.sync = sync_name(*type);
    }
  }
  return report;
}

}  // namespace edgesplat::livox
