// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/mapping/densify.hpp"

#include "common/base/check.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace edgesplat::mapping {
namespace {

using gaussian::GaussianCloud;

/// Smallest logit that a clone may end at: sigmoid is 1e-5 there, far below any pruning.
constexpr float kLeastOpacity = 1e-5F;

float opacity_of(float logit) {
  return 1.0F / (1.0F + std::exp(-logit));
}

float logit_of(float opacity) {
  const float o = std::clamp(opacity, kLeastOpacity, 1.0F - kLeastOpacity);
  return std::log(o / (1.0F - o));
}

std::size_t longest_axis(const GaussianCloud& cloud, std::size_t row) {
  const float* s = &cloud.log_scales[3 * row];
  return static_cast<std::size_t>(std::max_element(s, s + 3) - s);
}

float sigma_m(const GaussianCloud& cloud, std::size_t row) {
  return std::exp(cloud.log_scales[3 * row + longest_axis(cloud, row)]);
}

float mean_gradient(const RowStatistics& s) {
  return s.gradient_sum / static_cast<float>(s.sightings);
}
float mean_weight(const RowStatistics& s) {
  return s.weight_sum / static_cast<float>(s.sightings);
}

/// Rows to remove, in ascending order, and why.
std::vector<std::uint32_t> useless_rows(const Optimiser& optimiser, const DensifyOptions& options,
                                        DensifyReport& report) {
  const GaussianCloud& cloud = optimiser.cloud();
  std::vector<std::uint32_t> rows;
  for (std::size_t row = 0; row < cloud.size(); ++row) {
    const RowStatistics& seen = optimiser.statistics()[row];
    if (opacity_of(cloud.opacity_logits[row]) < options.min_opacity) {
      ++report.transparent;
    } else if (optimiser.switches().of(row) < optimiser.switches().least()) {
      ++report.switched_off;
    } else if (seen.radius_max_px > options.max_radius_px || sigma_m(cloud, row) > options.max_sigma_m) {
      ++report.large;
    } else if (seen.sightings >= options.min_sightings && mean_weight(seen) < options.min_weight_px) {
      ++report.idle;
    } else {
      continue;
    }
    rows.push_back(static_cast<std::uint32_t>(row));
  }
  return rows;
}

void remove(Optimiser& optimiser, std::span<const std::uint32_t> rows, DensifyReport& report) {
  if (rows.empty()) return;
  for (const std::uint32_t row : rows) report.removed.push_back(optimiser.cloud().ids[row]);
  const Status removed = optimiser.remove_rows(rows);
  EDGESPLAT_CHECK(removed.has_value(), "rows of this map");
}

/// Rows that want to grow, those that disagree most first.
std::vector<std::uint32_t> wanting_rows(const Optimiser& optimiser, const DensifyOptions& options) {
  const auto statistics = optimiser.statistics();
  std::vector<std::uint32_t> rows;
  for (std::size_t row = 0; row < statistics.size(); ++row) {
    const RowStatistics& seen = statistics[row];
    if (seen.sightings >= options.min_sightings && mean_gradient(seen) > options.gradient)
      rows.push_back(static_cast<std::uint32_t>(row));
  }
  std::stable_sort(rows.begin(), rows.end(), [&statistics](std::uint32_t a, std::uint32_t b) {
    return mean_gradient(statistics[a]) > mean_gradient(statistics[b]);
  });
  return rows;
}

/// The least useful rows that do not want to grow, to make room for `needed`.
std::vector<std::uint32_t> rows_to_shed(const Optimiser& optimiser, const DensifyOptions& options,
                                        std::size_t needed) {
  const auto statistics = optimiser.statistics();
  std::vector<std::uint32_t> rows;
  for (std::size_t row = 0; row < statistics.size(); ++row) {
    const RowStatistics& seen = statistics[row];
    if (seen.sightings >= options.min_sightings && mean_gradient(seen) <= options.gradient)
      rows.push_back(static_cast<std::uint32_t>(row));
  }
  const auto most = static_cast<std::size_t>(options.shed_share * static_cast<float>(statistics.size()));
  const std::size_t count = std::min({needed, most, rows.size()});
  std::stable_sort(rows.begin(), rows.end(), [&statistics](std::uint32_t a, std::uint32_t b) {
    return mean_weight(statistics[a]) < mean_weight(statistics[b]);
  });
  rows.resize(count);
  std::sort(rows.begin(), rows.end());
  return rows;
}

/// Both share what the parent covered: 1 - (1 - o)^2 is its opacity (Rota Bulo 2024, eq. 9).
void clone(GaussianCloud& cloud, std::size_t row, GaussianCloud& added) {
  float& logit = cloud.opacity_logits[row];
  logit = logit_of(1.0F - std::sqrt(1.0F - opacity_of(logit)));
  added.append_row(cloud, row);
}

/// Two halves side by side along the longest axis, whose spread together is about the parent's.
void split(GaussianCloud& cloud, std::size_t row, GaussianCloud& added) {
  constexpr float kApart = 0.65F;
  constexpr float kShrink = 0.7F;
  const std::size_t axis = longest_axis(cloud, row);
  const float* q = &cloud.quats_xyzw[4 * row];
  const Eigen::Vector3f along = Eigen::Quaternionf(q[3], q[0], q[1], q[2]).normalized() *
                                Eigen::Vector3f::Unit(static_cast<Eigen::Index>(axis)) * sigma_m(cloud, row) *
                                kApart;
  cloud.log_scales[3 * row + axis] += std::log(kShrink);
  added.append_row(cloud, row);
  for (std::size_t k = 0; k < 3; ++k) {
    const float step_m = along[static_cast<Eigen::Index>(k)];
    added.means_m[added.means_m.size() - 3 + k] += step_m;
    cloud.means_m[3 * row + k] -= step_m;
  }
}

void grow(Optimiser& optimiser, std::span<const std::uint32_t> rows, const DensifyOptions& options,
          IdAllocator& ids, DensifyReport& report) {
  if (rows.empty()) return;
  GaussianCloud added;
  added.sh_degree = optimiser.cloud().sh_degree;
  GaussianCloud& cloud = optimiser.edit_rows(rows);
  for (const std::uint32_t row : rows) {
    if (sigma_m(cloud, row) > options.split_sigma_m) {
      split(cloud, row, added);
      ++report.split;
    } else {
      clone(cloud, row, added);
      ++report.cloned;
    }
    added.ids.back() = ids.next();
  }
  optimiser.forget_moments(rows);
  const Result<std::size_t> count = optimiser.add_rows(added);
  EDGESPLAT_CHECK(count.has_value() && *count == added.size(), "room was asked for");
}

std::size_t room_in(const Optimiser& optimiser, const DensifyOptions& options) {
  const std::size_t rows = optimiser.cloud().size();
  return std::min(optimiser.room(), options.max_rows - std::min(options.max_rows, rows));
}

}  // namespace

DensifyReport densify(Optimiser& optimiser, const DensifyOptions& options, IdAllocator& ids) {
  DensifyReport report;
  remove(optimiser, useless_rows(optimiser, options, report), report);
  std::vector<std::uint32_t> wanting = wanting_rows(optimiser, options);
  const auto most =
      static_cast<std::size_t>(options.grow_share * static_cast<float>(optimiser.cloud().size()));
  const std::size_t wanted = wanting.size();
  wanting.resize(std::min(wanting.size(), most));
  if (wanting.size() > room_in(optimiser, options)) {
    const auto shed = rows_to_shed(optimiser, options, wanting.size() - room_in(optimiser, options));
    report.shed = shed.size();
    remove(optimiser, shed, report);
    if (!shed.empty()) {  // rows have moved up
      wanting = wanting_rows(optimiser, options);
      wanting.resize(std::min(wanting.size(), most));
    }
    wanting.resize(std::min(wanting.size(), room_in(optimiser, options)));
  }
  report.refused = wanted - wanting.size();
  grow(optimiser, wanting, options, ids, report);
  optimiser.reset_statistics();
  return report;
}

}  // namespace edgesplat::mapping
