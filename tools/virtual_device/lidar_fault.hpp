// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

namespace edgesplat::virtual_device {

/// Something that happens to a virtual LiDAR while a recording is played.
struct LidarFault {
  enum class Kind : std::uint8_t {
    kSilence,    ///< its cable is pulled for `lasts_s`
    kReboot,     ///< off for `lasts_s`, then on: its clock starts anew
    kAddress,    ///< off for `lasts_s`, then at another address
    kLoss,       ///< for `lasts_s` this share of its datagrams is lost, both ways
    kStuckSync,  ///< its PTP master is gone and it does not say so: its clock drifts
    kClockStep,  ///< its master's time jumps by `value` seconds
  };
  Kind kind = Kind::kSilence;
  double at_s = 0.0;     ///< of the recording
  double lasts_s = 0.0;  ///< [0, 3600]
  double value = 0.0;
  std::array<std::uint8_t, 4> address{};
};

/// "silence@3+2", "reboot@5+1.5", "address@8+1=127.0.0.9", "loss@10+5=0.05", "stuck-sync@12",
/// "clock-step@12=0.2". kInvalidConfig says what is wrong.
[[nodiscard]] Result<LidarFault> parse_lidar_fault(std::string_view text);

/// "127.0.0.9"; kInvalidConfig.
[[nodiscard]] Result<std::array<std::uint8_t, 4>> parse_address(const std::string& text);

}  // namespace edgesplat::virtual_device
