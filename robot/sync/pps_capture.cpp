// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/sync/pps_capture.hpp"

#include <fcntl.h>
#include <linux/pps.h>
#include <sys/ioctl.h>

#include <cerrno>
#include <cmath>
#include <limits>
#include <system_error>

namespace edgesplat::sync {
namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;
constexpr double kTolerance = 1e-3;  // 1000 ppm: no crystal is that bad
constexpr std::int64_t kMostSeconds = 60;
constexpr int kStraysForRestart = 3;
constexpr double kSmoothing = 0.1;
constexpr std::int64_t kMostOffSecond_ns = 300'000'000;

std::string system_text(int error) {
  return std::generic_category().message(error);
}

}  // namespace

Result<PpsDevice> PpsDevice::open(const std::string& path) {
  UniqueFd fd(::open(path.c_str(), O_RDWR | O_CLOEXEC));
  if (!fd.valid())
    return fail(Errc::kIo, "cannot open " + path + ": " + system_text(errno) +
                               "; is the pps-gpio or pps-ldisc module loaded, and may this user read it?");
  int abilities = 0;
  if (::ioctl(fd.get(), PPS_GETCAP, &abilities) != 0)
    return fail(Errc::kInvalidConfig, path + " is no PPS device: " + system_text(errno));
  if ((abilities & PPS_CAPTUREASSERT) == 0)
    return fail(Errc::kInvalidConfig, path + " cannot capture rising edges");
  pps_kparams parameters{};
  if (::ioctl(fd.get(), PPS_GETPARAMS, &parameters) != 0)
    return fail(Errc::kIo, "cannot read the settings of " + path + ": " + system_text(errno));
  if ((parameters.mode & PPS_CAPTUREASSERT) == 0) {
    parameters.mode |= PPS_CAPTUREASSERT;
    if (::ioctl(fd.get(), PPS_SETPARAMS, &parameters) != 0)
      return fail(Errc::kIo, "cannot turn on capturing of " + path + ": " + system_text(errno));
  }
  return PpsDevice(std::move(fd), path);
}

Result<std::optional<PpsEdge>> PpsDevice::wait(double timeout_s) {
  pps_fdata data{};
  data.timeout.sec = static_cast<std::int64_t>(timeout_s);
  data.timeout.nsec = static_cast<std::int32_t>((timeout_s - std::floor(timeout_s)) * 1e9);
  if (::ioctl(fd_.get(), PPS_FETCH, &data) != 0) {
    if (errno == ETIMEDOUT || errno == EINTR) return std::optional<PpsEdge>();
    return fail(Errc::kIo, "lost " + path_ + ": " + system_text(errno));
  }
  const std::uint32_t sequence = data.info.assert_sequence;
  if (newest_ == sequence) return std::optional<PpsEdge>();
  newest_ = sequence;
  return PpsEdge{sequence, data.info.assert_tu.sec * kSecond_ns + data.info.assert_tu.nsec};
}

bool PpsTrack::add(const PpsEdge& edge) {
  if (!newest_) {
    newest_ = edge;
    ++counters_.edges;
    return true;
  }
  const double seconds = (static_cast<double>(edge.wall_ns) - static_cast<double>(newest_->wall_ns)) * 1e-9;
  const double whole = std::round(seconds);
  const bool fits = whole >= 1.0 && whole <= static_cast<double>(kMostSeconds) &&
                    std::abs(seconds - whole) <= kTolerance * whole;
  if (!fits) {
    ++counters_.strays;
    if (++strays_in_a_row_ < kStraysForRestart) return false;
    ++counters_.restarts;  // a step of the clock, or another source: what came before tells nothing
    strays_in_a_row_ = 0;
    newest_ = edge;
    return false;
  }
  strays_in_a_row_ = 0;
  counters_.lost += static_cast<std::uint64_t>(whole) - 1;
  ++counters_.edges;
  const double error_ppm = 1e6 * (seconds - whole) / whole;
  period_error_ppm_ += (counters_.edges == 2 ? 1.0 : kSmoothing) * (error_ppm - period_error_ppm_);
  jitter_us_ += kSmoothing * (std::abs(error_ppm - period_error_ppm_) - jitter_us_);
  newest_ = edge;
  return true;
}

std::optional<std::int64_t> utc_of_edge(const PpsEdge& edge, bool on_seconds) {
  if (edge.wall_ns < 0) return std::nullopt;  // before 1970
  if (!on_seconds) return edge.wall_ns;
  const std::int64_t since_second_ns = edge.wall_ns % kSecond_ns;
  if (since_second_ns <= kMostOffSecond_ns) return edge.wall_ns - since_second_ns;
  const std::int64_t to_second_ns = kSecond_ns - since_second_ns;
  if (to_second_ns > kMostOffSecond_ns) return std::nullopt;
  if (edge.wall_ns > std::numeric_limits<std::int64_t>::max() - to_second_ns) return std::nullopt;
  return edge.wall_ns + to_second_ns;
}

}  // namespace edgesplat::sync
