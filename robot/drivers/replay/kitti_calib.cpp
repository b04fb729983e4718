// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/drivers/replay/kitti_calib.hpp"

#include <Eigen/Core>
#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>

namespace edgesplat::replay {
namespace {

constexpr double kLargest = 1e6;  // no focal length, baseline or shift of a camera is larger

struct Entry {
  std::string_view key;
  std::size_t values;
  std::array<double, 12> numbers{};
  bool found = false;
};

std::string at_line(std::string_view file_name, std::size_t line) {
  return std::string(file_name) + ":" + std::to_string(line) + ": ";
}

/// Exactly entry.values finite numbers of a sensible size, separated by blanks.
bool read_numbers(std::string_view text, Entry& entry) {
  std::size_t count = 0;
  const char* at = text.data();
  const char* end = text.data() + text.size();
  while (true) {
    while (at != end && (*at == ' ' || *at == '\t' || *at == '\r')) ++at;
    if (at == end) return count == entry.values;
    if (count == entry.values) return false;
    const auto [rest, error] = std::from_chars(at, end, entry.numbers.at(count));
    if (error != std::errc{} || !(std::abs(entry.numbers.at(count)) <= kLargest)) return false;
    at = rest;
    ++count;
  }
}

Eigen::Matrix<double, 3, 4> matrix34(const Entry& entry) {
  return Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>>(entry.numbers.data());
}

/// The projection's parts: intrinsics and where the camera sits in the rectified frame.
Result<sensor::CameraMount> compose(const Entry& projection, const Entry& rectification,
                                    const Entry& extrinsic, std::string_view file_name) {
  const Eigen::Matrix<double, 3, 4> pixel_from_rect = matrix34(projection);
  const Eigen::Matrix3d intrinsics = pixel_from_rect.leftCols<3>();
  const bool usable = intrinsics(0, 0) > 0 && intrinsics(1, 1) > 0 && intrinsics(2, 2) == 1.0 &&
                      intrinsics(1, 0) == 0 && intrinsics(2, 0) == 0 && intrinsics(2, 1) == 0;
  if (!usable)
    return fail(Errc::kInvalidConfig,
                std::string(file_name) + ": P_rect_02 is no projection (focal lengths > 0, last row 0 0 1)");
  using RowMajor3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  const Eigen::Matrix3d rect_from_cam0 = Eigen::Map<const RowMajor3>(rectification.numbers.data());
  Eigen::Matrix<double, 3, 4> camera_from_lidar = rect_from_cam0 * matrix34(extrinsic);
  camera_from_lidar.col(3) += intrinsics.inverse() * pixel_from_rect.col(3);
  sensor::CameraMount mount;
  mount.model.fx_px = intrinsics(0, 0);
  mount.model.fy_px = intrinsics(1, 1);
  mount.model.cx_px = intrinsics(0, 2);
  mount.model.cy_px = intrinsics(1, 2);
  const Eigen::Matrix3d rotation = camera_from_lidar.leftCols<3>();
  const double skew = (rotation.transpose() * rotation - Eigen::Matrix3d::Identity()).norm();
  if (!(skew < 1e-2) || rotation.determinant() < 0)
    return fail(Errc::kInvalidConfig,
                std::string(file_name) +
                    ": R_rect_00 * Tr_velo_to_cam is no rotation (its columns are off by " +
                    std::to_string(skew) + ")");
  mount.body_from_camera = geometry::RigidTransform::from_matrix(camera_from_lidar).inverse();
  return mount;
}

}  // namespace

Result<sensor::CameraMount> parse_kitti_camera(std::string_view text, std::string_view file_name,
                                               int width_px, int height_px) {
  std::array<Entry, 3> entries{Entry{"P_rect_02", 12}, Entry{"R_rect_00", 9}, Entry{"Tr_velo_to_cam", 12}};
  for (std::size_t line = 1; !text.empty(); ++line) {
    const std::string_view row = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(text.size(), row.size() + 1));
    const std::size_t colon = row.find(':');
    if (row.starts_with('#') || colon == std::string_view::npos) continue;
    for (Entry& entry : entries) {
      if (row.substr(0, colon) != entry.key) continue;
      if (!read_numbers(row.substr(colon + 1), entry))
        return fail(Errc::kInvalidConfig, at_line(file_name, line) + std::string(entry.key) + " needs " +
                                              std::to_string(entry.values) + " finite numbers");
      entry.found = true;
    }
  }
  for (const Entry& entry : entries)
    if (!entry.found)
      return fail(Errc::kInvalidConfig,
                  std::string(file_name) + ": " + std::string(entry.key) +
                      " is missing; needed are P_rect_02, R_rect_00 and Tr_velo_to_cam");
  EDGESPLAT_TRY(sensor::CameraMount mount, compose(entries[0], entries[1], entries[2], file_name));
  mount.model.width_px = width_px;
  mount.model.height_px = height_px;
  EDGESPLAT_TRY_STATUS(mount.model.validate());
  return mount;
}

}  // namespace edgesplat::replay
