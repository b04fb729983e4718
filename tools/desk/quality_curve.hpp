// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/desk/held_out.hpp"
#include "tools/desk/training.hpp"

#include <filesystem>
#include <vector>

namespace edgesplat::desk {

/// Held-out quality over training time as a CSV file: seconds, iterations, gaussians, psnr_db, ssim, lpips
/// (empty without the network); a line a look. The file is whole after every line, so that a training that is
/// stopped leaves its curve. Single-owner.
class QualityCurve {
 public:
  /// kIo where the file cannot be written.
  [[nodiscard]] static Result<QualityCurve> create(const std::filesystem::path& file);
  [[nodiscard]] Status add(const TrainingProgress& at, const HeldOutMeans& means);

 private:
  explicit QualityCurve(std::filesystem::path file) : file_(std::move(file)) {}
  std::filesystem::path file_;
  std::string text_;
};

/// Training seconds at which a curve is looked at: 1, 2, 4, 7, 14, 30, 60, 120, ... up to a day.
[[nodiscard]] std::vector<double> curve_times_s();

}  // namespace edgesplat::desk
