// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/link/transport.hpp"
#include "common/metrics/registry.hpp"

namespace edgesplat::link {

/// Adds to the counters link.<lane>.<field of LaneCounters>, e.g. link.keyframe.bytes_sent, of every lane
/// that was used, and sets the gauges link.<lane>.queued_*. To be called once, when the link is done with.
void record(metrics::Registry& registry, const LinkCounters& counters);
/// The same with what was done to the traffic on purpose: link.impaired.*.
void record(metrics::Registry& registry, const Transport& transport);

}  // namespace edgesplat::link
