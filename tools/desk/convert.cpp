// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/desk/convert.hpp"

#include "common/io/gaussian_file.hpp"

#include <algorithm>
#include <cmath>

namespace edgesplat::desk {
namespace {

using gaussian::GaussianCloud;
using io::GaussianFormat;

Result<GaussianFormat> format_of(const std::filesystem::path& path) {
  auto format = io::gaussian_format_of(path);
  if (!format) return fail(Errc::kInvalidConfig, format.error().context);
  return format;
}

double largest_difference(const std::vector<float>& a, const std::vector<float>& b) {
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    largest = std::max(largest, std::abs(static_cast<double>(a[i]) - static_cast<double>(b[i])));
  }
  return largest;
}

}  // namespace

Result<io::MapSidecar> save_map(const std::filesystem::path& path, const GaussianCloud& cloud,
                                io::MapSidecar sidecar, std::uint32_t spz_version) {
  EDGESPLAT_TRY(const GaussianFormat format, format_of(path));
  EDGESPLAT_TRY_STATUS(io::write_gaussians(path, cloud, spz_version));
  sidecar.stored_as = format == GaussianFormat::kSpz ? "x -y -z" : "x y z";
  sidecar.sh_degree = format == GaussianFormat::kSplat ? 0 : cloud.sh_degree;
  sidecar.gaussians = cloud.size();
  EDGESPLAT_TRY_STATUS(io::write_sidecar(path, sidecar));
  return sidecar;
}

Result<ConversionReport> convert_map(const Conversion& conversion) {
  EDGESPLAT_TRY_STATUS(format_of(conversion.in).and_then([](auto) { return Status(); }));
  EDGESPLAT_TRY_STATUS(format_of(conversion.out).and_then([](auto) { return Status(); }));
  EDGESPLAT_TRY(const GaussianCloud cloud, io::read_gaussians(conversion.in));
  EDGESPLAT_TRY(const auto sidecar, io::read_sidecar(conversion.in));
  ConversionReport report;
  report.sh_degree_in = cloud.sh_degree;
  EDGESPLAT_TRY(report.sidecar,
                save_map(conversion.out, cloud, sidecar.value_or(io::MapSidecar{}), conversion.spz_version));
  EDGESPLAT_TRY(const GaussianCloud written, io::read_gaussians(conversion.out));
  if (written.size() != cloud.size()) {
    return fail(Errc::kCorrupt, conversion.out.string() + " holds " + std::to_string(written.size()) +
                                    " Gaussians after writing " + std::to_string(cloud.size()));
  }
  report.gaussians = written.size();
  report.sh_degree_out = written.sh_degree;
  report.position_error_max = largest_difference(cloud.means_m, written.means_m);
  std::error_code ignored;
  report.bytes_in = std::filesystem::file_size(conversion.in, ignored);
  report.bytes_out = std::filesystem::file_size(conversion.out, ignored);
  return report;
}

}  // namespace edgesplat::desk
