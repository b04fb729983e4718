// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/gaussian/gaussian_cloud.hpp"
#include "common/io/map_sidecar.hpp"

#include <cstdint>
#include <filesystem>

namespace edgesplat::desk {

struct Conversion {
  std::filesystem::path in;
  std::filesystem::path out;
  std::uint32_t spz_version = 4;  ///< 2, 3 or 4; for .spz alone
};

/// What was written, as read back from the disk.
struct ConversionReport {
  std::uint64_t gaussians = 0;
  int sh_degree_in = 0;
  int sh_degree_out = 0;  ///< lower where the format has no place for it
  std::uint64_t bytes_in = 0;
  std::uint64_t bytes_out = 0;
  double position_error_max = 0.0;  ///< largest |x|, |y| or |z| difference, in the map's units
  io::MapSidecar sidecar;
};

/// Writes a map in another format with its sidecar, reads it back and compares. A sidecar of the input keeps
/// its word. Errors: kInvalidConfig for an ending that is none of the formats, else those of the formats.
[[nodiscard]] Result<ConversionReport> convert_map(const Conversion& conversion);

/// Writes `cloud` in the format of the path's ending, with a sidecar that says so. Fills in the sidecar's
/// stored_as, sh_degree and gaussians.
[[nodiscard]] Result<io::MapSidecar> save_map(const std::filesystem::path& path,
                                              const gaussian::GaussianCloud& cloud, io::MapSidecar sidecar,
                                              std::uint32_t spz_version = 4);

}  // namespace edgesplat::desk
