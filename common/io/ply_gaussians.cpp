// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/io/ply_gaussians.hpp"

#include "common/base/bytes.hpp"
#include "common/io/atomic_file.hpp"
#include "common/io/gaussian_values.hpp"
#include "common/io/ply_compressed.hpp"
#include "common/io/ply_table.hpp"

#include <array>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>

namespace edgesplat::io {
namespace {

using gaussian::GaussianCloud;

constexpr std::uint64_t kMaxFileBytes = std::uint64_t{16} << 30U;
constexpr std::array<std::string_view, 14> kFixedColumns = {
    "x",       "y",       "z",       "f_dc_0", "f_dc_1", "f_dc_2", "opacity",
    "scale_0", "scale_1", "scale_2", "rot_0",  "rot_1",  "rot_2",  "rot_3"};

std::string make_header(const GaussianCloud& cloud) {
  std::string header =
      "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(cloud.size()) + "\n";
  const auto add = [&header](const std::string& name) { header += "property float " + name + "\n"; };
  for (const char* name : {"x", "y", "z", "nx", "ny", "nz", "f_dc_0", "f_dc_1", "f_dc_2"}) add(name);
  for (std::size_t i = 0; i < cloud.sh_floats_each() - 3; ++i) add("f_rest_" + std::to_string(i));
  for (const char* name : {"opacity", "scale_0", "scale_1", "scale_2", "rot_0", "rot_1", "rot_2", "rot_3"}) {
    add(name);
  }
  return header + "end_header\n";
}

void append_row(const GaussianCloud& cloud, std::size_t row, std::vector<float>& out) {
  const float* mean = &cloud.means_m[row * 3];
  const float* sh = &cloud.sh[row * cloud.sh_floats_each()];
  const float* scale = &cloud.log_scales[row * 3];
  const float* quat = &cloud.quats_xyzw[row * 4];
  out.insert(out.end(), {mean[0], mean[1], mean[2], 0.0F, 0.0F, 0.0F, sh[0], sh[1], sh[2]});
  const std::size_t basis_count = cloud.sh_floats_each() / 3;
  for (std::size_t channel = 0; channel < 3; ++channel) {
    for (std::size_t basis = 1; basis < basis_count; ++basis) out.push_back(sh[basis * 3 + channel]);
  }
  out.insert(out.end(),
             {cloud.opacity_logits[row], scale[0], scale[1], scale[2], quat[3], quat[0], quat[1], quat[2]});
}

Status fill_row(std::span<const float> values, std::size_t row, GaussianCloud& cloud) {
  for (const float value : values) {
    if (!std::isfinite(value))
      return fail(Errc::kCorrupt, "Gaussian " + std::to_string(row) + " is not finite");
  }
  const std::array<float, 4> quat = {values[11], values[12], values[13], values[10]};
  const float norm = std::hypot(std::hypot(quat[0], quat[1]), std::hypot(quat[2], quat[3]));
  if (!(norm > 1e-12F) || !std::isfinite(norm)) {
    return fail(Errc::kCorrupt, "Gaussian " + std::to_string(row) + " has no rotation");
  }
  cloud.ids[row] = gaussian::GaussianId(0, row);
  for (std::size_t i = 0; i < 3; ++i) {
    cloud.means_m[row * 3 + i] = values[i];
    cloud.log_scales[row * 3 + i] = values[7 + i];
  }
  for (std::size_t i = 0; i < 4; ++i) cloud.quats_xyzw[row * 4 + i] = quat[i] / norm;
  cloud.opacity_logits[row] = values[6];
  float* sh = &cloud.sh[row * cloud.sh_floats_each()];
  const std::size_t basis_count = cloud.sh_floats_each() / 3;
  for (std::size_t channel = 0; channel < 3; ++channel) {
    sh[channel] = values[3 + channel];
    for (std::size_t basis = 1; basis < basis_count; ++basis) {
      sh[basis * 3 + channel] = values[kFixedColumns.size() + channel * (basis_count - 1) + basis - 1];
    }
  }
  return {};
}

}  // namespace

Result<int> ply::degree_of_rest_columns(const Table& table) {
  std::size_t count = 0;
  while (table.find("f_rest_" + std::to_string(count))) ++count;
  for (int degree = 0; degree <= 3; ++degree) {
    if (count == static_cast<std::size_t>((degree + 1) * (degree + 1) - 1) * 3) return degree;
  }
  return fail(Errc::kCorrupt,
              "a PLY file with " + std::to_string(count) + " f_rest columns: expected 0, 9, 24 or 45");
}

Status write_gaussians_ply(const std::filesystem::path& path, const GaussianCloud& cloud) {
  EDGESPLAT_TRY_STATUS(check_writable(cloud));
  EDGESPLAT_TRY(AtomicFile file, AtomicFile::create(path));
  const std::string header = make_header(cloud);
  EDGESPLAT_TRY_STATUS(file.append(std::as_bytes(std::span(header.data(), header.size()))));
  constexpr std::size_t kBlockFloats = std::size_t{1} << 16U;
  std::vector<float> block;
  for (std::size_t row = 0; row < cloud.size(); ++row) {
    append_row(cloud, row, block);
    if (block.size() < kBlockFloats && row + 1 < cloud.size()) continue;
    EDGESPLAT_TRY_STATUS(file.append(std::as_bytes(std::span(block))));
    block.clear();
  }
  return file.commit();
}

Result<GaussianCloud> parse_gaussians_ply(std::span<const std::byte> bytes) {
  EDGESPLAT_TRY(const auto file, ply::open_file(bytes));
  if (ply::is_compressed(file)) return ply::parse_compressed(file);
  EDGESPLAT_TRY(const auto table, ply::find_table(file, "vertex"));
  EDGESPLAT_TRY(const int degree, ply::degree_of_rest_columns(table));
  GaussianCloud cloud;
  cloud.sh_degree = degree;
  std::vector<std::size_t> columns;
  for (const auto name : kFixedColumns) {
    const auto column = table.find(name);
    if (!column)
      return fail(Errc::kCorrupt, "the PLY file has no column " + std::string(name) + ": no 3D Gaussians");
    columns.push_back(*column);
  }
  for (std::size_t i = 0; i + 3 < cloud.sh_floats_each(); ++i) {
    columns.push_back(*table.find("f_rest_" + std::to_string(i)));
  }
  EDGESPLAT_TRY(const auto values, ply::read_columns(table, columns));
  cloud.resize(table.row_count);
  for (std::size_t row = 0; row < table.row_count; ++row) {
    EDGESPLAT_TRY_STATUS(
        fill_row(std::span(values).subspan(row * columns.size(), columns.size()), row, cloud));
  }
  return cloud;
}

Result<GaussianCloud> read_gaussians_ply(const std::filesystem::path& path) {
  EDGESPLAT_TRY(const auto bytes, read_file(path, kMaxFileBytes));
  auto cloud = parse_gaussians_ply(bytes);
  if (!cloud) return fail(cloud.error().code, path.string() + ": " + cloud.error().context);
  return cloud;
}

}  // namespace edgesplat::io
