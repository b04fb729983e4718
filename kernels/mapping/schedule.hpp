// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "kernels/train/adam.hpp"

namespace edgesplat::mapping {

/// What changes while a map is fitted, by progress: 0 at the start, 1 at the end.
struct ScheduleOptions {
  double coarse_until = 0.0;  ///< pictures of half the size before, 0..1
  int sh_degree = 3;          ///< in the end, 0..3
  double sh_from = 0.0;       ///< SH degree 0 before, then one degree more at once, 0..1 ...
  double sh_every = 0.0;      ///< ... and another after so much more progress, 0..1
  double cool_from = 1.0;     ///< from here on all rates fall exponentially ..., 0..1
  float cool_to = 0.1F;       ///< ... to this share at the end, 1e-4..1
  double grow_from = 0.0;     ///< Gaussians are added and removed from here ..., 0..1
  double grow_until = 0.6;    ///< ... to here, 0..1

  /// kInvalidConfig with the field's name where a value lies outside its range.
  [[nodiscard]] Status validate() const;
};

/// Pure functions of progress; values outside 0..1 are taken as 0 or 1.
class Schedule {
 public:
  explicit Schedule(const ScheduleOptions& options) : options_(options) {}

  /// Pictures are so many times smaller: 1 or 2.
  [[nodiscard]] int shrink(double progress) const;
  [[nodiscard]] int sh_degree(double progress) const;
  /// Share of the rates at the start, 0..1.
  [[nodiscard]] float rate_share(double progress) const;
  [[nodiscard]] bool grows(double progress) const;

 private:
  ScheduleOptions options_;
};

/// All rates times `share`.
[[nodiscard]] train::LearningRates scaled(const train::LearningRates& rates, float share);

}  // namespace edgesplat::mapping
