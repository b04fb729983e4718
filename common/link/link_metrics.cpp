// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/link/link_metrics.hpp"

#include <string>
#include <utility>

namespace edgesplat::link {

void record(metrics::Registry& registry, const LinkCounters& counters) {
  for (const Lane lane : kLanes) {
    const LaneCounters& of = counters[static_cast<std::size_t>(lane)];
    if (of.messages_offered == 0 && of.chunks_received == 0) continue;
    const std::string prefix = "link." + std::string(to_string(lane)) + ".";
    const std::pair<const char*, std::uint64_t> events[] = {
        {"messages_offered", of.messages_offered},
        {"messages_dropped", of.messages_dropped},
        {"messages_replaced", of.messages_replaced},
        {"messages_withdrawn", of.messages_withdrawn},
        {"messages_sent", of.messages_sent},
        {"messages_acked", of.messages_acked},
        {"messages_given_up", of.messages_given_up},
        {"chunks_sent", of.chunks_sent},
        {"chunks_resent", of.chunks_resent},
        {"bytes_sent", of.bytes_sent},
        {"write_timeouts", of.write_timeouts},
        {"write_failures", of.write_failures},
        {"chunks_received", of.chunks_received},
        {"bytes_received", of.bytes_received},
        {"chunks_corrupt", of.chunks_corrupt},
        {"messages_received", of.messages_received},
        {"messages_corrupt", of.messages_corrupt},
        {"messages_lost", of.messages_lost},
        {"inbox_drops", of.inbox_drops},
    };
    for (const auto& [name, value] : events) registry.counter(prefix + name).add(value);
    const std::pair<const char*, std::size_t> levels[] = {
        {"queued_messages", of.queued_messages},     {"queued_bytes", of.queued_bytes},
        {"unsent_bytes", of.unsent_bytes},           {"flying_messages", of.flying_messages},
        {"flying_bytes", of.flying_bytes},           {"most_queued_messages", of.most_queued_messages},
        {"most_queued_bytes", of.most_queued_bytes}, {"most_flying_messages", of.most_flying_messages},
        {"most_flying_bytes", of.most_flying_bytes},
    };
    for (const auto& [name, value] : levels) registry.gauge(prefix + name).set(static_cast<double>(value));
  }
}

void record(metrics::Registry& registry, const Transport& transport) {
  record(registry, transport.counters());
  const auto done = transport.impairments();
  if (!done) return;
  registry.counter("link.impaired.lost").add(done->lost);
  registry.counter("link.impaired.duplicated").add(done->duplicated);
  registry.counter("link.impaired.reordered").add(done->reordered);
  registry.counter("link.impaired.flipped").add(done->flipped);
  registry.counter("link.impaired.held_back").add(done->held_back);
}

}  // namespace edgesplat::link
