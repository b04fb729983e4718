// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/sync/imu_buffer.hpp"

#include <algorithm>

namespace edgesplat::sync {
namespace {

bool at_or_before(HostTime t, const GroupImu& sample) {
  return t < sample.stamp;
}

}  // namespace

void ImuBuffer::push(GroupImu sample, HostTime settled, nanoseconds clamp) {
  if (sample.stamp <= settled) {
    if (settled - sample.stamp >= clamp) {
      ++late_;
      return;
    }
    const HostTime newest = samples_.empty() ? settled : std::max(settled, samples_.back().stamp);
    sample.stamp = newest + nanoseconds(1);
  }
  const auto place = std::upper_bound(samples_.begin(), samples_.end(), sample.stamp, at_or_before);
  if (place != samples_.begin() && std::prev(place)->stamp == sample.stamp) {
    ++late_;  // a second sample of the same moment tells nothing
    return;
  }
  samples_.insert(place, sample);
  if (samples_.size() > max_samples_) {
    samples_.pop_front();
    ++overflow_;
  }
}

std::vector<GroupImu> ImuBuffer::take(const Cut& cut) {
  const auto after_begin = std::upper_bound(samples_.begin(), samples_.end(), cut.begin, at_or_before);
  const auto after_end = std::upper_bound(after_begin, samples_.end(), cut.end, at_or_before);
  const auto first = after_begin == samples_.begin() ? after_begin : std::prev(after_begin);
  const bool ends_exactly = after_end != samples_.begin() && std::prev(after_end)->stamp == cut.end;
  const auto last = ends_exactly || after_end == samples_.end() ? after_end : std::next(after_end);
  std::vector<GroupImu> out(first, last);
  if (after_end != samples_.begin()) samples_.erase(samples_.begin(), std::prev(after_end));
  return out;
}

std::optional<HostTime> ImuBuffer::first_after(HostTime t) const {
  const auto place = std::upper_bound(samples_.begin(), samples_.end(), t, at_or_before);
  if (place == samples_.end()) return std::nullopt;
  return place->stamp;
}

}  // namespace edgesplat::sync
