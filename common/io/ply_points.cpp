// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/io/ply_points.hpp"

#include "common/base/bytes.hpp"
#include "common/io/atomic_file.hpp"
#include "common/io/ply_table.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>

namespace edgesplat::io {
namespace {

constexpr std::uint64_t kMaxFileBytes = std::uint64_t{16} << 30U;

/// Adds the three columns where all are there.
bool add_columns(const ply::Table& table, std::array<std::string_view, 3> names,
                 std::vector<std::size_t>& columns) {
  std::array<std::size_t, 3> found{};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto column = table.find(names[i]);
    if (!column) return false;
    found[i] = *column;
  }
  columns.insert(columns.end(), found.begin(), found.end());
  return true;
}

std::uint8_t to_colour(float value, bool is_float) {
  const float scaled = is_float ? value * 255.0F : value;  // float colours are 0..1
  return static_cast<std::uint8_t>(
      std::lround(std::clamp(std::isfinite(scaled) ? scaled : 0.0F, 0.0F, 255.0F)));
}

}  // namespace

Status write_points_ply(const std::filesystem::path& path, const PointCloud& cloud) {
  const bool coloured = !cloud.rgb.empty();
  if (coloured && cloud.rgb.size() != cloud.points_m.size()) {
    return fail(Errc::kInvalidArgument, "a point cloud with another number of colours than points");
  }
  std::string header = "ply\nformat binary_little_endian 1.0\nelement vertex " +
                       std::to_string(cloud.points_m.size()) +
                       "\nproperty float x\nproperty float y\nproperty float z\n";
  if (coloured) header += "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  header += "end_header\n";
  EDGESPLAT_TRY(AtomicFile file, AtomicFile::create(path));
  ByteWriter block;
  block.write_text(header);
  constexpr std::size_t kBlockBytes = std::size_t{1} << 18U;
  for (std::size_t i = 0; i < cloud.points_m.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) block.write(cloud.points_m[i][axis]);
    if (coloured) block.write_bytes(std::as_bytes(std::span(cloud.rgb[i])));
    if (block.size() < kBlockBytes) continue;
    EDGESPLAT_TRY_STATUS(file.append(block.bytes()));
    block.clear();
  }
  EDGESPLAT_TRY_STATUS(file.append(block.bytes()));
  return file.commit();
}

Result<PointCloud> parse_points_ply(std::span<const std::byte> bytes) {
  EDGESPLAT_TRY(const auto table, ply::open_vertices(bytes));
  std::vector<std::size_t> columns;
  if (!add_columns(table, {"x", "y", "z"}, columns))
    return fail(Errc::kCorrupt, "the PLY file has no x, y, z");
  const bool coloured = add_columns(table, {"red", "green", "blue"}, columns);
  EDGESPLAT_TRY(const auto values, ply::read_columns(table, columns));
  PointCloud cloud;
  cloud.points_m.reserve(table.row_count);
  if (coloured) cloud.rgb.reserve(table.row_count);
  for (std::size_t row = 0; row < table.row_count; ++row) {
    const float* value = &values[row * columns.size()];
    cloud.points_m.emplace_back(value[0], value[1], value[2]);
    if (!coloured) continue;
    std::array<std::uint8_t, 3> rgb{};
    for (std::size_t i = 0; i < 3; ++i) {
      const auto type = table.properties[columns[3 + i]].type;
      rgb[i] = to_colour(value[3 + i], type == ply::Type::kFloat32 || type == ply::Type::kFloat64);
    }
    cloud.rgb.push_back(rgb);
  }
  return cloud;
}

Result<PointCloud> read_points_ply(const std::filesystem::path& path) {
  EDGESPLAT_TRY(const auto bytes, read_file(path, kMaxFileBytes));
  auto cloud = parse_points_ply(bytes);
  if (!cloud) return fail(cloud.error().code, path.string() + ": " + cloud.error().context);
  return cloud;
}

}  // namespace edgesplat::io
