// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace edgesplat::io {

/// What a map file cannot say about itself; written beside it as <file>.json.
struct MapSidecar {
  std::string frame = "unknown";  ///< the frame that coordinates are in: "map", "odom", a scene's name
  std::string units = "unknown";  ///< "m", or "unknown" where the scale is
  std::string axes = "unknown";   ///< of the frame: "z up", ... as the map's maker has them
  /// How the file turns the frame's coordinates: "x y z" as they are, "x -y -z" in .spz.
  std::string stored_as = "x y z";
  int sh_degree = 0;  ///< 0..3
  std::string colour_space = "sRGB";
  std::uint64_t epoch = 0;    ///< of the server's map; 0 where there is none
  bool sky_included = false;  ///< Gaussians stand for the sky
  std::uint64_t gaussians = 0;
  bool operator==(const MapSidecar&) const = default;
};

/// "a.ply" -> "a.ply.json".
[[nodiscard]] std::filesystem::path sidecar_path(const std::filesystem::path& map_file);
[[nodiscard]] Status write_sidecar(const std::filesystem::path& map_file, const MapSidecar& sidecar);
/// Nothing where there is no sidecar; kCorrupt where it is damaged.
[[nodiscard]] Result<std::optional<MapSidecar>> read_sidecar(const std::filesystem::path& map_file);
[[nodiscard]] Result<MapSidecar> parse_sidecar(std::string_view text);

}  // namespace edgesplat::io
