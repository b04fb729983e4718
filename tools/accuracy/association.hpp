// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/io/trajectory_file.hpp"

#include <filesystem>
#include <optional>
#include <span>
#include <vector>

namespace edgesplat::accuracy {

/// The two poses that an evaluation compares at one moment; each in its own world frame.
struct PosePair {
  HostTime stamp{};  ///< the estimate's
  geometry::RigidTransform estimate;
  geometry::RigidTransform reference;
};

/// Pairs each pose of the shorter trajectory with the nearest one of the longer, in time order; pairs more
/// than `max_diff` apart are left out (evo's association). Neither trajectory has to be sorted.
[[nodiscard]] std::vector<PosePair> associate(std::span<const io::StampedPose> estimate,
                                              std::span<const io::StampedPose> reference,
                                              nanoseconds max_diff);

/// Pairs each pose of the estimate with the reference at the same moment, interpolated (positions linearly,
/// rotations by slerp) between two reference poses at most `max_gap` apart; poses without such a bracket are
/// left out. With a reference of 200 Hz the nearest pose may be 2.5 ms away: 3 mm at walking pace.
[[nodiscard]] std::vector<PosePair> associate_interpolated(std::span<const io::StampedPose> estimate,
                                                           std::span<const io::StampedPose> reference,
                                                           nanoseconds max_gap);

/// What a simulated recording says of its body's true way. kNotFound where it does not.
[[nodiscard]] Result<std::vector<io::StampedPose>> read_recorded_truth(
    const std::filesystem::path& recording);

enum class ReferenceFormat { kTum, kKitti };

struct ReferenceSource {
  std::filesystem::path path;
  ReferenceFormat format = ReferenceFormat::kTum;
  std::optional<std::filesystem::path> times;  ///< KITTI: times.txt, one stamp a pose
  double rate_hz = 10.0;                       ///< KITTI without times: pose i is at i / rate_hz
};

/// Reads a reference. KITTI poses have no stamps: theirs come from `times`, else from `rate_hz`, counted from
/// 0 where `start` (the estimate's first stamp) lies in the first second, else from `start`. Errors
/// of the files, and kInvalidArgument where times and poses differ in number.
[[nodiscard]] Result<std::vector<io::StampedPose>> read_reference(const ReferenceSource& source,
                                                                  HostTime start);

}  // namespace edgesplat::accuracy
