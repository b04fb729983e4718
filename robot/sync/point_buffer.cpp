// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/sync/point_buffer.hpp"

#include <algorithm>
#include <limits>

namespace edgesplat::sync {
namespace {

std::int32_t before_end(HostTime end, HostTime t) {
  constexpr std::int64_t kLongest = std::numeric_limits<std::int32_t>::max();
  return static_cast<std::int32_t>(std::min((end - t).count(), kLongest));
}

}  // namespace

void PointBuffer::push(HostTime first_ray, std::vector<sensor::LidarPoint> points) {
  if (points.empty()) return;
  size_ += points.size();
  const auto later = [](HostTime t, const Packet& packet) { return t < packet.first_ray; };
  const auto place = std::upper_bound(packets_.begin(), packets_.end(), first_ray, later);
  packets_.insert(place, Packet{first_ray, std::move(points), 0});
  while (size_ > max_points_) {
    const std::size_t dropped = packets_.front().points.size() - packets_.front().taken;
    overflow_ += dropped;
    size_ -= dropped;
    packets_.pop_front();
  }
}

std::vector<GroupPoint> PointBuffer::take(const Cut& cut, nanoseconds clamp) {
  std::vector<GroupPoint> out;
  std::size_t expected = 0;
  for (const Packet& packet : packets_)
    if (packet.first_ray <= cut.end) expected += packet.points.size() - packet.taken;
  out.reserve(expected);
  for (Packet& packet : packets_) {
    if (packet.first_ray > cut.end) break;
    take_from(packet, cut, clamp, out);
  }
  std::erase_if(packets_, [](const Packet& packet) { return packet.taken == packet.points.size(); });
  // Packets that overlap in time (two echoes, refined clocks) leave the order; mostly nothing is to be done.
  const auto older = [](const GroupPoint& a, const GroupPoint& b) {
    return a.before_end_ns > b.before_end_ns;
  };
  if (!std::is_sorted(out.begin(), out.end(), older)) std::stable_sort(out.begin(), out.end(), older);
  return out;
}

void PointBuffer::take_from(Packet& packet, const Cut& cut, nanoseconds clamp, std::vector<GroupPoint>& out) {
  for (; packet.taken < packet.points.size(); ++packet.taken) {
    const sensor::LidarPoint& point = packet.points[packet.taken];
    HostTime t = packet.first_ray + nanoseconds(point.offset_ns);
    if (t > cut.end) return;
    --size_;
    if (t <= cut.begin) {
      if (cut.begin - t >= clamp) {
        ++late_;
        continue;
      }
      ++clamped_;
      t = cut.begin + nanoseconds(1);
    }
    out.push_back({point.p_in_lidar_m, point.reflectivity, before_end(cut.end, t), point.noise_class, unit_});
  }
}

std::optional<HostTime> PointBuffer::earliest() const {
  if (packets_.empty()) return std::nullopt;
  const Packet& packet = packets_.front();
  return packet.first_ray + nanoseconds(packet.points[packet.taken].offset_ns);
}

}  // namespace edgesplat::sync
