// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/app/pps_input.hpp"

#include "common/log/log.hpp"
#include "common/thread/pause.hpp"

#include <memory>
#include <utility>

namespace edgesplat::app {
namespace {

constexpr double kWait_s = 0.25;  // the kernel's wait does not hear a stop
constexpr auto kRetry = std::chrono::seconds(1);
constexpr auto kSilence = std::chrono::milliseconds(2500);
constexpr std::int64_t kOldest_ns = 1'000'000'000;

}  // namespace

Result<PpsInput> PpsInput::open(const robot_config::PpsSettings& config, const Clock& clock) {
  EDGESPLAT_TRY(sync::PpsDevice opened, sync::PpsDevice::open(config.device));
  const auto device = std::make_shared<std::optional<sync::PpsDevice>>(std::move(opened));
  return PpsInput(
      config,
      [device, path = config.device](double timeout_s) -> Result<std::optional<sync::PpsEdge>> {
        if (!*device) {
          EDGESPLAT_TRY(*device, sync::PpsDevice::open(path));
        }
        auto edge = (*device)->wait(timeout_s);
        if (!edge) device->reset();
        return edge;
      },
      clock, wall_clock_ns);
}

void PpsInput::receive(const std::stop_token& stop, const Sink& sink) {
  HostTime heard = clock_->now();
  while (!stop.stop_requested()) {
    const auto edge = wait_(kWait_s);
    if (!edge) {
      ++counters_.failures;
      note(false, edge.error().context.c_str());
      thread::pause(stop, kRetry);
    } else if (*edge) {
      heard = clock_->now();
      on_edge(**edge, sink);
    } else if (clock_->now() - heard > kSilence) {
      note(false, "no pulse comes: is the line connected, and does the receiver have a fix?");
    }
  }
}

void PpsInput::on_edge(const sync::PpsEdge& edge, const Sink& sink) {
  if (!track_.add(edge)) return;
  // The kernel stamps with the wall clock; the edge's age carries it to the program's.
  const ClockPair now = read_clocks(*clock_, wall_ns_);
  const std::int64_t age_ns = now.wall_ns - edge.wall_ns;
  if (age_ns < 0 || age_ns > kOldest_ns) {
    ++counters_.stale;
    return;
  }
  const auto utc_ns = sync::utc_of_edge(edge, config_.on_seconds);
  if (!utc_ns) {
    ++counters_.off_second;
    note(
        false,
        "the pulses are not at full seconds of this machine's clock: is it set? else pps.on_seconds = false");
    return;
  }
  ++counters_.told;
  note(true, "pulses come");
  sink(now.host_at(edge.wall_ns), *utc_ns);
}

/// One line for each change.
void PpsInput::note(bool in_order, const char* why) {
  if (in_order_ == in_order) return;
  in_order_ = in_order;
  if (in_order) {
    EDGESPLAT_LOG_INFO("pps", why);
  } else {
    EDGESPLAT_LOG_WARN("pps", "not in order", "why", why);
  }
}

void PpsInput::publish_counters(metrics::Registry& metrics) const {
  const sync::PpsCounters& c = track_.counters();
  metrics.counter("pps.edges").add(c.edges);
  metrics.counter("pps.lost").add(c.lost);
  metrics.counter("pps.strays").add(c.strays);
  metrics.counter("pps.restarts").add(c.restarts);
  metrics.counter("pps.told").add(counters_.told);
  metrics.counter("pps.off_second").add(counters_.off_second);
  metrics.counter("pps.stale").add(counters_.stale);
  metrics.counter("pps.failures").add(counters_.failures);
  metrics.gauge("pps.period_error_ppm").set(track_.period_error_ppm());
  metrics.gauge("pps.jitter_us").set(track_.jitter_us());
}

}  // namespace edgesplat::app
