// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/drivers/replay/bag_points.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <string>
#include <string_view>
#include <utility>

namespace edgesplat::replay {
namespace {

constexpr std::int64_t kLongestSweep_ns = 1'000'000'000;

/// 0 good, 1 medium, 2 noise: as the drivers for both protocols have it.
std::uint8_t confidence_of(unsigned tag, LivoxTags tags) {
  const std::array<unsigned, 3> fields{tag & 3U, (tag >> 2U) & 3U, (tag >> 4U) & 3U};
  if (tags == LivoxTags::kSdk2)
    return static_cast<std::uint8_t>(std::min(2U, std::max({fields[0], fields[1], fields[2]})));
  const auto sdk1 = [](unsigned bits) -> std::uint8_t { return bits == 0 ? 0 : (bits == 1 ? 2 : 1); };
  return std::max(sdk1(fields[0]), sdk1(fields[1]));  // the third says which return of the shot it is
}

template <typename T>
double read_as(const std::byte* at) {
  T value;
  std::memcpy(&value, at, sizeof(T));
  return static_cast<double>(value);
}

double read_number(const std::byte* at, io::RosFieldType type) {
  switch (type) {
    case io::RosFieldType::kInt8:
      return read_as<std::int8_t>(at);
    case io::RosFieldType::kUint8:
      return read_as<std::uint8_t>(at);
    case io::RosFieldType::kInt16:
      return read_as<std::int16_t>(at);
    case io::RosFieldType::kUint16:
      return read_as<std::uint16_t>(at);
    case io::RosFieldType::kInt32:
      return read_as<std::int32_t>(at);
    case io::RosFieldType::kUint32:
      return read_as<std::uint32_t>(at);
    case io::RosFieldType::kFloat32:
      return read_as<float>(at);
    case io::RosFieldType::kFloat64:
      return read_as<double>(at);
  }
  return 0.0;
}

/// The first of these names that the cloud has.
const io::RosPointField* find_field(const io::RosPointCloud& cloud,
                                    std::initializer_list<std::string_view> names) {
  for (const std::string_view name : names)
    for (const io::RosPointField& field : cloud.fields)
      if (field.name == name && io::bytes_of(field.type) > 0) return &field;
  return nullptr;
}

bool is_float(io::RosFieldType type) {
  return type == io::RosFieldType::kFloat32 || type == io::RosFieldType::kFloat64;
}

double ns_per(PointTimeUnit unit) {
  switch (unit) {
    case PointTimeUnit::kSeconds:
      return 1e9;
    case PointTimeUnit::kMilliseconds:
      return 1e6;
    case PointTimeUnit::kMicroseconds:
      return 1e3;
    case PointTimeUnit::kNanoseconds:
    case PointTimeUnit::kAuto:
      break;
  }
  return 1.0;
}

/// Sweeps last 0.02 to 1 s: the unit in which this one does. `extent` of 1.7e9 s is a time of day.
double guess_ns_per_unit(double extent) {
  double ns = 1e9;
  for (double limit = 2.0; extent > limit && ns > 1.0; limit *= 1e3) ns /= 1e3;
  return ns;
}

double guess_ns_per_unit_of_day(double time) {
  double ns = 1e9;
  for (double limit = 1e11; time > limit && ns > 1.0; limit *= 1e3) ns /= 1e3;
  return ns;
}

}  // namespace

struct BagPoints::Columns {
  const io::RosPointField* x;
  const io::RosPointField* y;
  const io::RosPointField* z;
  const io::RosPointField* intensity;
  const io::RosPointField* ring;
  const io::RosPointField* time;

  explicit Columns(const io::RosPointCloud& cloud)
      : x(find_field(cloud, {"x"})),
        y(find_field(cloud, {"y"})),
        z(find_field(cloud, {"z"})),
        intensity(find_field(cloud, {"intensity", "reflectivity"})),
        ring(find_field(cloud, {"ring", "line", "channel"})),
        time(find_field(cloud, {"t", "time", "timestamp", "time_stamp", "offset_time"})) {}
  static double at(const std::byte* point, const io::RosPointField* field) {
    return field == nullptr ? 0.0 : read_number(point + field->offset, field->type);
  }
};

bool BagPoints::keep(const Eigen::Vector3f& p_m) {
  const bool good = p_m.allFinite() && !p_m.isZero(0.0F);
  if (!good) ++dropped_;
  return good;
}

Result<std::optional<sensor::Measurement>> BagPoints::packet(SensorTime header_stamp, HostTime arrival,
                                                             std::vector<TimedPoint> points) const {
  if (points.empty()) return std::nullopt;
  const auto earlier = [](const TimedPoint& a, const TimedPoint& b) { return a.t_ns < b.t_ns; };
  if (!std::is_sorted(points.begin(), points.end(), earlier))
    std::stable_sort(points.begin(), points.end(), earlier);
  const std::int64_t first_ns = points.front().t_ns;
  const std::int64_t span_ns = points.back().t_ns - first_ns;
  if (span_ns > kLongestSweep_ns || std::abs(first_ns) > 2 * kLongestSweep_ns) {
    return fail(Errc::kCorrupt, "the points of a sweep are " +
                                    std::to_string(static_cast<double>(span_ns) * 1e-9) +
                                    " s apart: set point_time_unit in [replay] of the rig's file");
  }
  sensor::LidarPacket packet;
  packet.stamp = header_stamp + nanoseconds(first_ns) + from_seconds(settings_.lidar_stamp_offset_s);
  packet.arrival = arrival;
  packet.stamp_source =
      settings_.clock == StampClock::kHeader ? sensor::StampSource::kPtp : sensor::StampSource::kFreeRunning;
  packet.span = nanoseconds(span_ns);
  packet.points.reserve(points.size());
  for (TimedPoint& timed : points) {
    timed.point.offset_ns = static_cast<std::int32_t>(timed.t_ns - first_ns);
    packet.points.push_back(timed.point);
  }
  return packet;
}

Result<std::optional<sensor::Measurement>> BagPoints::convert(const io::LivoxCustomMessage& message,
                                                              LivoxTags tags, HostTime arrival) {
  std::vector<TimedPoint> points;
  points.reserve(message.points.size());
  for (const io::LivoxCustomPoint& raw : message.points) {
    if (!keep(raw.p_m)) continue;
    const std::uint8_t confidence = confidence_of(raw.tag, tags);
    if (confidence >= 2) {
      ++dropped_;
      continue;
    }
    sensor::LidarPoint point;
    point.p_in_lidar_m = raw.p_m;
    point.reflectivity = static_cast<float>(raw.reflectivity) / 255.0F;
    point.line = raw.line;
    point.noise_class = confidence;
    points.push_back({raw.offset_ns, point});
  }
  return packet(message.header.stamp, arrival, std::move(points));
}

void BagPoints::set_times(std::vector<TimedPoint>& points, const std::vector<double>& times,
                          bool whole_numbers, SensorTime header_stamp) {
  constexpr double kTimeOfDay = 5e8;  // no sweep has as many units
  const auto [least, most] = std::minmax_element(times.begin(), times.end());
  const bool of_day = !whole_numbers && *least > kTimeOfDay;
  if (!ns_per_unit_) {
    if (settings_.point_time_unit != PointTimeUnit::kAuto) {
      ns_per_unit_ = ns_per(settings_.point_time_unit);
    } else if (whole_numbers) {
      ns_per_unit_ = 1.0;
    } else {
      ns_per_unit_ = of_day ? guess_ns_per_unit_of_day(*most) : guess_ns_per_unit(*most - *least);
    }
  }
  constexpr double kLargest_ns = 4e18;
  const double header_ns = static_cast<double>(to_ns(header_stamp));
  // Subtracted before it is scaled: a double holds a time of day to 0.2 us only.
  double base = 0.0;
  std::int64_t base_after_header_ns = 0;
  if (of_day) {
    base = *least;
    const double least_ns = std::min(base * *ns_per_unit_, kLargest_ns);
    if (std::abs(least_ns - header_ns) < static_cast<double>(kLongestSweep_ns))
      base_after_header_ns = static_cast<std::int64_t>(least_ns) - to_ns(header_stamp);
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double after_ns =
        std::clamp((times[i] - base) * *ns_per_unit_, -kLargest_ns / 4.0, kLargest_ns / 4.0);
    points[i].t_ns = base_after_header_ns + std::llround(after_ns);
  }
}

Result<std::optional<sensor::Measurement>> BagPoints::convert(const io::RosPointCloud& cloud,
                                                              HostTime arrival) {
  const Columns columns(cloud);
  if (columns.x == nullptr || columns.y == nullptr || columns.z == nullptr)
    return fail(Errc::kCorrupt, "a PointCloud2 without the fields x, y and z");
  std::vector<TimedPoint> points;
  std::vector<double> times;
  // The bytes are there, so this is no more than a point takes for each point_step of them.
  points.reserve(cloud.data.size() / std::max(12U, cloud.point_step));
  for (std::uint32_t row = 0; row < cloud.height; ++row) {
    const std::byte* at = cloud.data.data() + std::size_t{row} * cloud.row_step;
    for (std::uint32_t column = 0; column < cloud.width; ++column, at += cloud.point_step) {
      sensor::LidarPoint point;
      point.p_in_lidar_m =
          Eigen::Vector3d(Columns::at(at, columns.x), Columns::at(at, columns.y), Columns::at(at, columns.z))
              .cast<float>();
      const double time = Columns::at(at, columns.time);
      if (!keep(point.p_in_lidar_m)) continue;
      if (!std::isfinite(time)) {
        ++dropped_;
        continue;
      }
      const double share = Columns::at(at, columns.intensity) / settings_.full_intensity;
      point.reflectivity = std::isfinite(share) ? static_cast<float>(std::clamp(share, 0.0, 1.0)) : 0.0F;
      const double ring = Columns::at(at, columns.ring);
      point.line = ring >= 0.0 && ring <= 255.0 ? static_cast<std::uint8_t>(ring) : std::uint8_t{0};
      points.push_back({0, point});
      times.push_back(time);
    }
  }
  if (points.empty()) return std::nullopt;
  const auto [least, most] = std::minmax_element(times.begin(), times.end());
  if (columns.time != nullptr && *least < *most) {
    set_times(points, times, !is_float(columns.time->type), cloud.header.stamp);
    return packet(cloud.header.stamp, arrival, std::move(points));
  }
  sensor::LidarScan scan;
  scan.stamp = cloud.header.stamp + from_seconds(settings_.lidar_stamp_offset_s);
  scan.arrival = arrival;
  scan.points.reserve(points.size());
  for (const TimedPoint& timed : points) scan.points.push_back(timed.point);
  return scan;
}

}  // namespace edgesplat::replay
