// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

namespace edgesplat::livox {

/// What can happen to a LiDAR. Each is one line in the log and one counter.
enum class LidarEventKind : std::uint8_t {
  kFound,           ///< a unit answered and is brought up
  kSampling,        ///< it measures
  kSilent,          ///< its points or IMU samples stopped
  kRecovered,       ///< they are back
  kUnreachable,     ///< it does not answer
  kMoved,           ///< it has another address
  kRefused,         ///< it refused a setting
  kNoFirmware,      ///< it runs its loader only
  kForeign,         ///< another unit is on the wire
  kSyncChanged,     ///< its clock is disciplined by something else, or no more
  kFault,           ///< it reports a fault
  kClockRestarted,  ///< its stamps started anew
  kCount
};
inline constexpr std::size_t kLidarEventKinds = static_cast<std::size_t>(LidarEventKind::kCount);

struct LidarEvent {
  LidarEventKind kind;
  std::string detail;  ///< for people
};

/// A kind for the log and for metrics.
struct LidarEventName {
  const char* words;    ///< "fell silent"
  const char* counter;  ///< "silences", of "livox.silences"
  bool is_problem;      ///< a warning rather than information
};
[[nodiscard]] const LidarEventName& name_of(LidarEventKind kind);

struct LidarSessionCounters {
  std::array<std::uint64_t, kLidarEventKinds> events{};  ///< by LidarEventKind
  std::uint64_t requests = 0;
  std::uint64_t retries = 0;     ///< requests that were repeated
  std::uint64_t bad_frames = 0;  ///< control datagrams that failed a check
  std::uint64_t utc_told = 0;    ///< seconds told to a LiDAR on a pulse line
};

}  // namespace edgesplat::livox
