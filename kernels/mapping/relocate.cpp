// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/mapping/relocate.hpp"

#include "common/base/check.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <span>

namespace edgesplat::mapping {
namespace {

using gaussian::GaussianCloud;

constexpr std::size_t kMostCopies = 51;
constexpr float kMostOpacity = 1.0F - 1e-6F;

float opacity_of(float logit) {
  return 1.0F / (1.0F + std::exp(-logit));
}
float logit_of(float opacity) {
  return std::log(opacity / (1.0F - opacity));
}

std::vector<std::uint32_t> dead_rows(const Optimiser& optimiser, const RelocateOptions& options) {
  const GaussianCloud& cloud = optimiser.cloud();
  const PruneSwitches& switches = optimiser.switches();
  std::vector<std::uint32_t> rows;
  const float most = std::log(options.max_sigma_m);
  for (std::size_t row = 0; row < cloud.size(); ++row) {
    const float* s = &cloud.log_scales[3 * row];
    if (opacity_of(cloud.opacity_logits[row]) < options.min_opacity || *std::max_element(s, s + 3) > most ||
        switches.of(row) < switches.least())
      rows.push_back(static_cast<std::uint32_t>(row));
  }
  return rows;
}

/// How many new rows each row gets: `count` draws in proportion to opacity.
std::vector<std::uint8_t> draw_places(const GaussianCloud& cloud, std::size_t count, std::mt19937& random) {
  std::vector<double> until(cloud.size());
  double sum = 0.0;
  for (std::size_t row = 0; row < cloud.size(); ++row) {
    sum += static_cast<double>(opacity_of(cloud.opacity_logits[row]));
    until[row] = sum;
  }
  std::vector<std::uint8_t> draws(cloud.size(), 0);
  for (std::size_t i = 0; i < count; ++i) {
    const double at = sum * (static_cast<double>(random()) / 4294967296.0);
    const auto place = std::min(static_cast<std::size_t>(std::ranges::upper_bound(until, at) - until.begin()),
                                cloud.size() - 1);
    if (draws[place] + 1U < kMostCopies) ++draws[place];
  }
  return draws;
}

/// A standard normal number (Box and Muller 1958); std::normal_distribution differs between libraries.
float normal(std::mt19937& random) {
  constexpr double kTurn = 6.283185307179586;
  const double u = (static_cast<double>(random()) + 0.5) / 4294967296.0;
  const double v = static_cast<double>(random()) / 4294967296.0;
  return static_cast<float>(std::sqrt(-2.0 * std::log(u)) * std::cos(kTurn * v));
}

/// How much noise a Gaussian of this opacity gets: 1 where it is transparent, nothing above some 0.05.
float faintness(float opacity) {
  constexpr float kSteepness = 100.0F, kMiddle = 0.995F;  // Kheradmand 2024, eq. 8
  return 1.0F / (1.0F + std::exp(-kSteepness * ((1.0F - opacity) - kMiddle)));
}

}  // namespace

SharedLook shared_look(float opacity, std::size_t copies) {
  const std::size_t n = std::clamp<std::size_t>(copies, 1, kMostCopies);
  const double old_opacity = static_cast<double>(std::clamp(opacity, 1e-6F, kMostOpacity));
  const double each = 1.0 - std::pow(1.0 - old_opacity, 1.0 / static_cast<double>(n));
  double sum = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    double term = each;  // C(i, k) (-1)^k each^(k + 1)
    for (std::size_t k = 0; k <= i; ++k) {
      sum += term / std::sqrt(static_cast<double>(k + 1));
      term *= -each * static_cast<double>(i - k) / static_cast<double>(k + 1);
    }
  }
  return {static_cast<float>(each), static_cast<float>(old_opacity / sum)};
}

RelocateReport Relocator::relocate(Optimiser& optimiser, IdAllocator& ids) {
  RelocateReport report;
  const auto dead = dead_rows(optimiser, options_);
  if (dead.size() == optimiser.cloud().size()) return report;  // nowhere to go
  for (const std::uint32_t row : dead) report.removed.push_back(optimiser.cloud().ids[row]);
  if (!dead.empty()) {
    const Status removed = optimiser.remove_rows(dead);
    EDGESPLAT_CHECK(removed.has_value(), "rows of this map");
  }
  const std::size_t before = optimiser.cloud().size() + dead.size();
  const auto grown = before + static_cast<std::size_t>(options_.grow_share * static_cast<float>(before));
  const std::size_t wanted = std::max(before, std::min(grown, options_.max_rows)) - optimiser.cloud().size();
  const auto draws = draw_places(optimiser.cloud(), std::min(wanted, optimiser.room()), random_);
  std::vector<std::uint32_t> places;
  for (std::size_t row = 0; row < draws.size(); ++row) {
    if (draws[row] > 0) places.push_back(static_cast<std::uint32_t>(row));
  }
  GaussianCloud added;
  added.sh_degree = optimiser.cloud().sh_degree;
  GaussianCloud& cloud = optimiser.edit_rows(places);
  for (const std::uint32_t row : places) {
    const SharedLook look = shared_look(opacity_of(cloud.opacity_logits[row]), draws[row] + std::size_t{1});
    cloud.opacity_logits[row] = logit_of(std::clamp(look.opacity, options_.min_opacity, kMostOpacity));
    for (std::size_t k = 0; k < 3; ++k) cloud.log_scales[3 * row + k] += std::log(look.scale_factor);
    for (std::size_t copy = 0; copy < draws[row]; ++copy) {
      added.append_row(cloud, row);
      added.ids.back() = ids.next();
    }
  }
  optimiser.forget_moments(places);
  report.moved = std::min(added.size(), dead.size());
  report.added = added.size() - report.moved;
  const Result<std::size_t> count = optimiser.add_rows(added);
  EDGESPLAT_CHECK(count.has_value() && *count == added.size(), "room was asked for");
  optimiser.reset_statistics();
  return report;
}

void Relocator::shake(Optimiser& optimiser, float rate_share) {
  constexpr float kLeast = 1e-3F;
  if (options_.noise_per_m * rate_share <= 0.0F) return;
  std::vector<std::uint32_t> rows;
  const auto& logits = optimiser.cloud().opacity_logits;
  for (std::size_t row = 0; row < logits.size(); ++row) {
    if (faintness(opacity_of(logits[row])) > kLeast) rows.push_back(static_cast<std::uint32_t>(row));
  }
  GaussianCloud& cloud = optimiser.edit_rows(rows);
  for (const std::uint32_t row : rows) {
    const float* q = &cloud.quats_xyzw[4 * row];
    const Eigen::Quaternionf turn = Eigen::Quaternionf(q[3], q[0], q[1], q[2]).normalized();
    Eigen::Vector3f step =
        turn.conjugate() * Eigen::Vector3f(normal(random_), normal(random_), normal(random_));
    for (int k = 0; k < 3; ++k) {
      const float scale_m = std::exp(cloud.log_scales[3 * row + static_cast<std::size_t>(k)]);
      step[k] *= scale_m * scale_m;
    }
    step =
        turn * step * (options_.noise_per_m * rate_share * faintness(opacity_of(cloud.opacity_logits[row])));
    for (std::size_t k = 0; k < 3; ++k) cloud.means_m[3 * row + k] += step[static_cast<Eigen::Index>(k)];
  }
}

}  // namespace edgesplat::mapping
