// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/mapping/seed.hpp"

#include "common/map/chunk_id.hpp"
#include "kernels/mapping/neighbour_grid.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace edgesplat::mapping {
namespace {

using Eigen::Vector3f;

/// The points of one keyframe that fall into one cell the map does not cover.
struct NewCell {
  int level = 0;
  Eigen::Vector3d sum_m = Eigen::Vector3d::Zero();
  Vector3f sum_rgb = Vector3f::Zero();
  float count = 0.0F;
};

/// Size and attitude of one Gaussian.
struct Shape {
  Vector3f sigma_m;
  Eigen::Quaternionf map_from_gaussian = Eigen::Quaternionf::Identity();
};

Vector3f srgb(const map::ColouredPoint& point) {
  if (!point.has_colour) return Vector3f::Constant(0.5F);
  return Vector3f(point.rgb[0], point.rgb[1], point.rgb[2]) / 255.0F;
}

/// Finds the cells to fill and adds up their points. `points_in_map_m` gets every usable point, new or not.
class NewCells {
 public:
  NewCells(const SeedOptions& options, const CoverageGrid& coverage, SeedStats& stats)
      : options_(options), coverage_(coverage), stats_(stats) {}

  void collect(const SeedInput& input, std::vector<Vector3f>& points_in_map_m) {
    const Eigen::Matrix3f rotation = input.map_from_body.rotation.toRotationMatrix().cast<float>();
    const Vector3f translation_m = input.map_from_body.translation_m.cast<float>();
    points_in_map_m.reserve(input.points_in_body.size());
    for (const auto& point : input.points_in_body) {
      ++stats_.points;
      const Vector3f p_m = rotation * point.p_in_body_m + translation_m;
      const float range_m = point.p_in_body_m.norm();
      // Written so that NaN is out of range too.
      const bool near = range_m <= options_.max_range_m || input.spacing_rad > 0.0F;
      if (!near || !std::isfinite(range_m) || !(p_m.cwiseAbs().maxCoeff() < map::kMapLimit_m)) {
        ++stats_.out_of_range;
        continue;
      }
      points_in_map_m.push_back(p_m);
      if (input.has_camera && !point.has_colour) {
        ++stats_.uncoloured;
        continue;
      }
      add(p_m, coverage_.level_of(range_m), srgb(point));
    }
  }
  [[nodiscard]] const std::vector<NewCell>& cells() const { return cells_; }

 private:
  void add(const Vector3f& p_m, int level, const Vector3f& rgb) {
    const auto key = coverage_.key(level, p_m);
    if (coverage_.covered(level, key)) {
      ++stats_.covered;
      return;
    }
    auto& numbers = numbers_[static_cast<std::size_t>(level)];
    const std::size_t known = numbers.size();
    const std::uint32_t number = numbers.find_or_add(key);
    auto& of_level = index_[static_cast<std::size_t>(level)];
    if (numbers.size() != known) {
      of_level.push_back(cells_.size());
      cells_.push_back({level});
    }
    NewCell& cell = cells_[of_level[number]];
    cell.sum_m += p_m.cast<double>();
    cell.sum_rgb += rgb;
    cell.count += 1.0F;
  }

  const SeedOptions& options_;
  const CoverageGrid& coverage_;
  SeedStats& stats_;
  std::array<VoxelTable, CoverageGrid::kLevels> numbers_;
  std::array<std::vector<std::size_t>, CoverageGrid::kLevels> index_;  ///< number -> place in cells_
  std::vector<NewCell> cells_;                                         ///< in the order of first sight
};

/// Neighbours at two scales: most points find theirs close by, the sparse ones look farther.
class Surroundings {
 public:
  Surroundings(std::span<const Vector3f> points_m, float near_cell_m)
      : points_m_(points_m), close_(points_m, 2.0F * near_cell_m), far_(points_m, 10.0F * near_cell_m) {}
  [[nodiscard]] Neighbours nearest(const Vector3f& p_m) const {
    const Neighbours close = close_.nearest(p_m);
    return close.count == Neighbours::kMost ? close : far_.nearest(p_m);
  }
  [[nodiscard]] const Vector3f& point(std::uint32_t index) const { return points_m_[index]; }

 private:
  std::span<const Vector3f> points_m_;
  NeighbourGrid close_;
  NeighbourGrid far_;
};

float mean_distance_to_three(const Neighbours& neighbours, float otherwise_m) {
  if (neighbours.count < 3) return otherwise_m;
  float sum = 0.0F;
  for (std::size_t i = 0; i < 3; ++i) sum += std::sqrt(neighbours.squared_m2[i]);
  return sum / 3.0F;
}

Shape shape_at(const Vector3f& p_m, float cell_m, const Surroundings& around, const SeedOptions& options) {
  const Neighbours neighbours = around.nearest(p_m);
  // Neighbours nearer than the cell are not seeded themselves: the Gaussian has to fill the cell.
  const float spacing_m = std::max(mean_distance_to_three(neighbours, cell_m), 0.9F * cell_m);
  const float sigma_m =
      std::clamp(options.sigma_per_spacing * spacing_m, options.min_sigma_m, options.max_sigma_m);
  Shape shape{Vector3f::Constant(sigma_m)};
  if (neighbours.count < 5) return shape;
  Vector3f mean_m = Vector3f::Zero();
  for (std::size_t i = 0; i < neighbours.count; ++i) mean_m += around.point(neighbours.index[i]);
  mean_m /= static_cast<float>(neighbours.count);
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < neighbours.count; ++i) {
    const Eigen::Vector3d d = (around.point(neighbours.index[i]) - mean_m).cast<double>();
    scatter += d * d.transpose();
  }
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(scatter);
  const Eigen::Vector3d& values = solver.eigenvalues();  // ascending
  if (!(values[0] <= static_cast<double>(options.plane_max_ratio) * values[1]) || values[1] <= 0.0)
    return shape;
  const Vector3f normal = solver.eigenvectors().col(0).cast<float>();
  shape.map_from_gaussian = Eigen::Quaternionf::FromTwoVectors(Vector3f::UnitZ(), normal).normalized();
  shape.sigma_m.z() = std::max(options.flat_ratio * sigma_m, 0.2F * options.min_sigma_m);
  return shape;
}

void append(gaussian::GaussianCloud& cloud, const Vector3f& mean_m, const Shape& shape, const Vector3f& rgb) {
  for (int k = 0; k < 3; ++k) {
    cloud.means_m.push_back(mean_m[k]);
    cloud.log_scales.push_back(std::log(shape.sigma_m[k]));
    cloud.sh.push_back((rgb[k] - 0.5F) / gaussian::GaussianCloud::kShC0);
  }
  for (int k = 0; k < 4; ++k) cloud.quats_xyzw.push_back(shape.map_from_gaussian.coeffs()[k]);
}

/// A ball as wide as the pixels that it stands for.
Shape ball_at(const Vector3f& p_m, const SeedInput& input, const SeedOptions& options) {
  const float range_m = (p_m - input.map_from_body.translation_m.cast<float>()).norm();
  return {Vector3f::Constant(
      std::max(options.sigma_per_spacing * input.spacing_rad * range_m, options.min_sigma_m))};
}

}  // namespace

void MapSeeder::cover(const gaussian::GaussianCloud& cloud) {
  // How far away each was measured is not known any more. As of the finest level, it fills its cell of every
  // level: right for the cells of its own level, and of finer ones only the one that it lies in.
  for (std::size_t row = 0; row < cloud.size(); ++row) {
    const float* mean_m = &cloud.means_m[3 * row];
    coverage_.fill(0, {mean_m[0], mean_m[1], mean_m[2]});
  }
}

gaussian::GaussianCloud MapSeeder::seed(const SeedInput& input) {
  std::vector<Vector3f> points_in_map_m;
  NewCells found(options_, coverage_, stats_);
  found.collect(input, points_in_map_m);
  gaussian::GaussianCloud cloud;
  if (found.cells().empty()) return cloud;
  const Surroundings around(points_in_map_m, options_.coverage.near_cell_m);
  const float logit = std::log(options_.opacity / (1.0F - options_.opacity));
  for (const NewCell& cell : found.cells()) {
    const Vector3f mean_m = (cell.sum_m / static_cast<double>(cell.count)).cast<float>();
    append(cloud, mean_m,
           input.spacing_rad > 0.0F ? ball_at(mean_m, input, options_)
                                    : shape_at(mean_m, coverage_.cell_m(cell.level), around, options_),
           cell.sum_rgb / cell.count);
    cloud.ids.push_back(ids_.next());
    cloud.opacity_logits.push_back(logit);
    cloud.anchors.push_back(input.anchor);
    coverage_.fill(cell.level, mean_m);
  }
  stats_.seeded += cloud.size();
  return cloud;
}

}  // namespace edgesplat::mapping
