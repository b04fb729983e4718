// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "test/common/io/bag_samples.hpp"

#include <Eigen/Core>

#include <string>
#include <utility>
#include <vector>

/// Messages of sensors as their .msg files define them.
namespace edgesplat::io {

inline std::vector<std::byte> imu_message(RosEncoding encoding, std::int64_t stamp_ns,
                                          const Eigen::Vector3d& gyro, const Eigen::Vector3d& accel) {
  RosWriter w(encoding);
  w.header(stamp_ns, "imu_link");
  for (int i = 0; i < 4 + 9; ++i) w.put(0.25 * i);
  for (int i = 0; i < 3; ++i) w.put(gyro[i]);
  for (int i = 0; i < 9; ++i) w.put(-1.0);
  for (int i = 0; i < 3; ++i) w.put(accel[i]);
  for (int i = 0; i < 9; ++i) w.put(-1.0);
  return w.take();
}

struct SamplePoint {
  std::uint32_t offset_ns;
  float x, y, z;
  std::uint8_t reflectivity, tag, line;
};
inline std::vector<std::byte> livox_message(RosEncoding encoding, std::int64_t stamp_ns,
                                            const std::vector<SamplePoint>& points) {
  RosWriter w(encoding);
  w.header(stamp_ns, "livox_frame");
  w.put(static_cast<std::uint64_t>(stamp_ns)).put(static_cast<std::uint32_t>(points.size()));
  for (int i = 0; i < 4; ++i) w.put(std::uint8_t{0});
  w.put(static_cast<std::uint32_t>(points.size()));
  for (const SamplePoint& p : points)
    w.put(p.offset_ns).put(p.x).put(p.y).put(p.z).put(p.reflectivity).put(p.tag).put(p.line);
  return w.take();
}

struct SampleField {
  std::string name;
  std::uint32_t offset;
  std::uint8_t type;
};
struct SampleCloud {
  std::vector<SampleField> fields;
  std::uint32_t point_step = 0;
  std::uint32_t width = 0;
  std::uint32_t height = 1;
  std::vector<std::byte> data;
  bool big_endian = false;
};
inline std::vector<std::byte> cloud_message(RosEncoding encoding, std::int64_t stamp_ns,
                                            const SampleCloud& cloud) {
  RosWriter w(encoding);
  w.header(stamp_ns, "lidar");
  w.put(cloud.height).put(cloud.width).put(static_cast<std::uint32_t>(cloud.fields.size()));
  for (const SampleField& field : cloud.fields)
    w.text(field.name).put(field.offset).put(field.type).put(std::uint32_t{1});
  w.put(static_cast<std::uint8_t>(cloud.big_endian ? 1 : 0)).put(cloud.point_step);
  w.put(cloud.width * cloud.point_step).blob(cloud.data).put(std::uint8_t{1});
  return w.take();
}

inline std::vector<std::byte> image_message(RosEncoding encoding, std::int64_t stamp_ns, std::uint32_t width,
                                            std::uint32_t height, std::string_view pixels, std::uint32_t step,
                                            std::span<const std::byte> data) {
  RosWriter w(encoding);
  w.header(stamp_ns, "cam").put(height).put(width).text(pixels).put(std::uint8_t{0}).put(step).blob(data);
  return w.take();
}

inline std::vector<std::byte> compressed_image_message(RosEncoding encoding, std::int64_t stamp_ns,
                                                       std::string_view format,
                                                       std::span<const std::byte> data) {
  RosWriter w(encoding);
  w.header(stamp_ns, "cam").text(format).blob(data);
  return w.take();
}

}  // namespace edgesplat::io
