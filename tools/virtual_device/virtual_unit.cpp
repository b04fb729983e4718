// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/virtual_device/virtual_unit.hpp"

namespace edgesplat::virtual_device {

void VirtualUnit::on_command(std::uint16_t port, const UnitAddress& from, std::span<const std::byte> datagram,
                             std::int64_t now_ns) {
  if (!is_up(now_ns)) return;
  answer(port, from, datagram, now_ns);
}

void VirtualUnit::step(std::int64_t now_ns) {
  if (is_up(now_ns)) act(now_ns);
}

void VirtualUnit::power_cycle(std::int64_t now_ns, std::int64_t off_ns) {
  const std::int64_t on_ns = now_ns + off_ns;
  ready_at_ns_ = on_ns + seconds_to_ns(config_.boot_s);
  clock_.restart(on_ns);
  forget(ready_at_ns_);
}

bool VirtualUnit::hear_second(std::int64_t now_ns, std::int64_t utc_ns, std::int64_t earliest_ns,
                              std::int64_t latest_ns) {
  constexpr std::int64_t kSecond_ns = 1'000'000'000;
  const std::int64_t after_pulse_ns = clock_.master_ns(now_ns) % kSecond_ns;
  ++counters_.seconds_told;
  if (after_pulse_ns < earliest_ns || after_pulse_ns > latest_ns) {
    ++counters_.seconds_late;
    return false;
  }
  clock_.tell_second(now_ns, utc_ns);
  return true;
}

}  // namespace edgesplat::virtual_device
