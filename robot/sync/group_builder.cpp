// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/sync/group_builder.hpp"

#include "robot/sync/group_stages.hpp"

#include <utility>

namespace edgesplat::sync {

GroupBuilder::GroupBuilder(const GroupBuilderConfig& config, const sensor::Rig& rig)
    : stages_(std::make_unique<Stages>(config, rig)) {}
GroupBuilder::GroupBuilder(GroupBuilder&&) noexcept = default;
GroupBuilder& GroupBuilder::operator=(GroupBuilder&&) noexcept = default;
GroupBuilder::~GroupBuilder() = default;

void GroupBuilder::on_imu(std::function<void(const GroupImu&)> listener) {
  stages_->on_imu(std::move(listener));
}

std::vector<MeasureGroup> GroupBuilder::push(sensor::Measurement measurement) {
  stages_->take_in(measurement);
  return stages_->drain(false);
}

std::vector<MeasureGroup> GroupBuilder::flush() {
  return stages_->drain(true);
}

std::optional<TimeBase::ClockState> GroupBuilder::clock_state(Stream stream) const {
  return stages_->time_base().clock_state(stream);
}

GroupCounters GroupBuilder::counters() const {
  return stages_->counters();
}

}  // namespace edgesplat::sync
