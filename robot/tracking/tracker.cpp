// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/tracking/tracker.hpp"

#include <utility>

namespace edgesplat::tracking {

struct Tracker::Impl {
  TrackingConfig config;
  sensor::Rig rig;
  TrackingCounters counters;
};

Tracker::Tracker(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Tracker::~Tracker() = default;

Result<std::unique_ptr<Tracker>> Tracker::create(const TrackingConfig& config, const sensor::Rig& rig) {
  EDGESPLAT_TRY_STATUS(validate(config));
  return std::unique_ptr<Tracker>(new Tracker(std::make_unique<Impl>(Impl{config, rig, {}})));
}

Result<TrackedGroup> Tracker::track(const sync::MeasureGroup& group) {
  TrackedGroup tracked;
  tracked.stamp = group.end;
  return tracked;
}

TrackingCounters Tracker::counters() const {
  return impl_->counters;
}

}  // namespace edgesplat::tracking
