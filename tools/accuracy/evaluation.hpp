// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/accuracy/association.hpp"

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace edgesplat::accuracy {

/// Of a list of errors; all 0 for an empty list.
struct ErrorStatistics {
  std::size_t count = 0;
  double rmse = 0.0;
  double mean = 0.0;
  double median = 0.0;  ///< mean of the middle two for an even count
  double stddev = 0.0;  ///< of the population
  double min = 0.0;
  double max = 0.0;
};
[[nodiscard]] ErrorStatistics statistics_of(std::vector<double> errors);

/// The rigid transform that maps estimated positions onto the reference's with least squared error (Umeyama
/// 1991 without scale). Identity for no pairs, a pure translation for one.
[[nodiscard]] geometry::RigidTransform align(std::span<const PosePair> pairs);

/// Distance of each estimated position, moved by `reference_from_estimate`, from its reference (m).
[[nodiscard]] std::vector<double> absolute_errors_m(std::span<const PosePair> pairs,
                                                    const geometry::RigidTransform& reference_from_estimate);

struct RelativeErrors {
  ErrorStatistics translation_m;
  ErrorStatistics rotation_deg;
};
/// Error of the motion between consecutive pairs (evo's RPE, delta 1 frame).
[[nodiscard]] RelativeErrors relative_errors_per_frame(std::span<const PosePair> pairs);
/// The same over consecutive stretches of `distance_m` of the reference's path (evo's delta in metres with
/// pairs from the reference); the last incomplete stretch is left out.
[[nodiscard]] RelativeErrors relative_errors_per_distance(std::span<const PosePair> pairs, double distance_m);

/// End-to-end error: both trajectories start in the same full pose, how far apart do they end. Global
/// alignment would hide drift.
struct EndToEndError {
  double distance_m = 0.0;
  double percent_of_path = 0.0;  ///< 0 where the reference did not move
};
[[nodiscard]] EndToEndError end_to_end_error(std::span<const PosePair> pairs);

/// Averages over all (start, length) segments of the KITTI odometry devkit: starts every 10 frames, distance
/// along the reference, the segment ends at the first frame beyond the length.
struct KittiErrors {
  double translation_percent = 0.0;
  double rotation_deg_per_m = 0.0;
  std::size_t segments = 0;
};
inline constexpr std::array<double, 8> kKittiLengths_m = {100, 200, 300, 400, 500, 600, 700, 800};
/// Nothing where the reference is shorter than every length.
[[nodiscard]] std::optional<KittiErrors> kitti_errors(std::span<const PosePair> pairs,
                                                      std::span<const double> lengths_m = kKittiLengths_m);

/// Length of the reference's path over the pairs (m).
[[nodiscard]] double reference_path_m(std::span<const PosePair> pairs);

struct Evaluation {
  std::size_t pairs = 0;
  double duration_s = 0.0;
  double path_m = 0.0;
  geometry::RigidTransform reference_from_estimate;  ///< the alignment behind `absolute_m`
  ErrorStatistics absolute_m;                        ///< ATE after rigid alignment
  RelativeErrors per_frame;
  RelativeErrors per_metre;
  EndToEndError end_to_end;
  std::optional<KittiErrors> kitti;
};
/// Everything at once. Wants at least two pairs: kInvalidArgument otherwise.
[[nodiscard]] Result<Evaluation> evaluate(std::span<const PosePair> pairs);

}  // namespace edgesplat::accuracy
