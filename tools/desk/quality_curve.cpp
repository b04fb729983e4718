// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/desk/quality_curve.hpp"

#include "common/io/atomic_file.hpp"

#include <fmt/format.h>

namespace edgesplat::desk {

Result<QualityCurve> QualityCurve::create(const std::filesystem::path& file) {
  QualityCurve curve(file);
  curve.text_ = "seconds,iterations,gaussians,psnr_db,ssim,lpips\n";
  EDGESPLAT_TRY_STATUS(io::write_file_atomically(file, curve.text_));
  return curve;
}

Status QualityCurve::add(const TrainingProgress& at, const HeldOutMeans& means) {
  text_ += fmt::format("{:.3f},{},{},{:.3f},{:.4f},{}\n", at.seconds, at.iterations, at.gaussians,
                       means.psnr_db, means.ssim, means.lpips ? fmt::format("{:.4f}", *means.lpips) : "");
  return io::write_file_atomically(file_, text_);
}

std::vector<double> curve_times_s() {
  std::vector<double> times{1.0, 2.0, 4.0, 7.0, 14.0, 30.0};
  constexpr double kDay_s = 86400.0;
  for (double t = 60.0; t <= kDay_s; t *= 2.0) times.push_back(t);
  return times;
}

}  // namespace edgesplat::desk
