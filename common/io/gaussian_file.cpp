// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/io/gaussian_file.hpp"

#include "common/io/ply_gaussians.hpp"
#include "common/io/splat_gaussians.hpp"
#include "common/io/spz_gaussians.hpp"

#include <algorithm>
#include <cctype>
#include <string>

namespace edgesplat::io {

std::string_view to_string(GaussianFormat format) {
  switch (format) {
    case GaussianFormat::kSpz:
      return "spz";
    case GaussianFormat::kSplat:
      return "splat";
    case GaussianFormat::kPly:
      break;
  }
  return "ply";
}

Result<GaussianFormat> gaussian_format_of(const std::filesystem::path& path) {
  std::string ending = path.extension().string();
  std::ranges::transform(ending, ending.begin(), [](unsigned char letter) { return std::tolower(letter); });
  for (const auto format : {GaussianFormat::kPly, GaussianFormat::kSpz, GaussianFormat::kSplat}) {
    if (ending == "." + std::string(to_string(format))) return format;
  }
  return fail(Errc::kInvalidArgument, "cannot tell the format of " + path.string() +
                                          ": expected a name ending in .ply, .spz or .splat");
}

Result<gaussian::GaussianCloud> read_gaussians(const std::filesystem::path& path) {
  EDGESPLAT_TRY(const GaussianFormat format, gaussian_format_of(path));
  switch (format) {
    case GaussianFormat::kSpz:
      return read_gaussians_spz(path);
    case GaussianFormat::kSplat:
      return read_gaussians_splat(path);
    case GaussianFormat::kPly:
      break;
  }
  return read_gaussians_ply(path);
}

Status write_gaussians(const std::filesystem::path& path, const gaussian::GaussianCloud& cloud,
                       std::uint32_t spz_version) {
  EDGESPLAT_TRY(const GaussianFormat format, gaussian_format_of(path));
  switch (format) {
    case GaussianFormat::kSpz:
      return write_gaussians_spz(path, cloud, spz_version);
    case GaussianFormat::kSplat:
      return write_gaussians_splat(path, cloud);
    case GaussianFormat::kPly:
      break;
  }
  return write_gaussians_ply(path, cloud);
}

}  // namespace edgesplat::io
