// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/gaussian/gaussian_cloud.hpp"
#include "common/geometry/rigid_transform.hpp"
#include "common/map/ids.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace edgesplat::store {

/// Where a keyframe is, as last corrected.
struct StoredPose {
  std::uint32_t keyframe = 0;
  std::uint32_t version = 0;
  geometry::RigidTransform map_from_body;
};

/// One robot's map as it outlives the server.
struct StoredMap {
  map::MapUuid map;
  map::RobotId robot;
  std::uint64_t session = 0;          ///< of the robot's program whose odometry frame the map lies in
  map::Epoch epoch;                   ///< of the server that saved it
  std::uint64_t next_id_counter = 0;  ///< first that no Gaussian has had
  std::vector<StoredPose> poses;
  gaussian::GaussianCloud gaussians;
};

struct MapFileOptions {
  /// Floats beside the integers, for the training to go on where it was; twice the size and more.
  bool full_precision = true;
};

/// What a damaged file cost.
struct LoadReport {
  std::size_t gaussians_lost = 0;
  std::size_t gaussians_rounded = 0;  ///< their floats are damaged or absent: as the robot has them
  bool poses_lost = false;
  std::size_t damaged_bytes = 0;

  [[nodiscard]] bool whole() const { return gaussians_lost == 0 && !poses_lost && damaged_bytes == 0; }
};
struct LoadedMap {
  StoredMap map;
  LoadReport report;
};

inline constexpr std::uint64_t kMaxMapFile_bytes = std::uint64_t{8} << 30U;

/// Takes the file's bytes part by part.
using ByteSink = std::function<Status(std::span<const std::byte>)>;
/// Errors: the sink's; kInvalidArgument for arrays that disagree. Gaussians that cannot be quantised (not
/// finite, beyond the map) are left out.
[[nodiscard]] Status write_map(const StoredMap& map, const MapFileOptions& options, const ByteSink& sink);
/// Every Gaussian whose record is whole, in the order of chunk and id. kCorrupt where it is no map file, of
/// another version, or both copies of its head are damaged.
[[nodiscard]] Result<LoadedMap> read_map(std::span<const std::byte> bytes);

/// Whole or not at all: temporary neighbour, fsync, rename, fsync of the folder. The old file stays until
/// then. kIo with the system's reason (a full disk among them).
[[nodiscard]] Status save_map(const std::filesystem::path& path, const StoredMap& map,
                              const MapFileOptions& options = {});
/// kNotFound, kIo; as of read_map().
[[nodiscard]] Result<LoadedMap> load_map(const std::filesystem::path& path);

}  // namespace edgesplat::store
