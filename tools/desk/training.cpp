// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/desk/training.hpp"

#include "common/sensor/image_values.hpp"
#include "kernels/mapping/densify.hpp"
#include "kernels/mapping/optimiser.hpp"
#include "tools/desk/scene_start.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace edgesplat::desk {
namespace {

/// The optimiser's defaults are for scenes in metres: scenes are scaled to this extent while they are
/// trained.
constexpr double kTrainingExtent_m = 5.0;
constexpr std::size_t kLeastPoints = 10;
constexpr std::uint16_t kOrigin = 1;

mapping::OptimiserOptions optimiser_options(const TrainingOptions& options) {
  mapping::OptimiserOptions out;
  out.sh_degree = options.sh_degree;
  out.max_gaussians = options.max_gaussians;
  out.rates.mean_m = 1.6e-4F * static_cast<float>(kTrainingExtent_m);
  out.rates.opacity_logit = 5e-2F;
  out.exposure.rate = options.learn_exposure ? 1e-3F : 0.0F;
  return out;
}

mapping::DensifyOptions densify_options() {
  mapping::DensifyOptions out;
  out.split_sigma_m = 0.01F * static_cast<float>(kTrainingExtent_m);
  out.gradient = 1e-4F;
  out.grow_share = 0.3F;
  out.max_sigma_m = 0.5F * static_cast<float>(kTrainingExtent_m);
  return out;
}

/// One picture after the other in shuffled rounds.
class Rounds {
 public:
  explicit Rounds(std::size_t count) : order_(count) {
    for (std::size_t i = 0; i < count; ++i) order_[i] = i;
  }
  std::size_t next() {
    if (at_ == 0) {
      for (std::size_t i = order_.size(); i > 1; --i) std::swap(order_[i - 1], order_[random_() % i]);
      at_ = order_.size();
    }
    return order_[--at_];
  }

 private:
  std::vector<std::size_t> order_;
  std::size_t at_ = 0;
  std::mt19937 random_{1};
};

class Training {
 public:
  Training(std::span<const ScenePicture* const> pictures, const TrainingOptions& options, double scale,
           mapping::Optimiser optimiser, mapping::IdAllocator ids, const Clock& clock)
      : pictures_(pictures),
        options_(options),
        scale_(scale),
        optimiser_(std::move(optimiser)),
        ids_(ids),
        rounds_(pictures.size()),
        clock_(clock) {}

  Result<TrainedMap> run(const std::function<void(const TrainingProgress&)>& tell) {
    const HostTime begin = clock_.now();
    double told_s = 0.0;
    while (progress() < 1.0) {
      EDGESPLAT_TRY_STATUS(iterate());
      state_.seconds = to_seconds(clock_.now() - begin);
      if (state_.seconds < told_s + 1.0) continue;
      told_s = state_.seconds;
      tell(state_);
    }
    tell(state_);
    TrainedMap out{optimiser_.cloud(), state_.iterations, state_.seconds};
    const auto back = static_cast<float>(1.0 / scale_);
    for (float& value : out.map.means_m) value *= back;
    for (float& value : out.map.log_scales) value += std::log(back);
    return out;
  }

 private:
  [[nodiscard]] double progress() const {
    const double of_iterations = options_.iterations == 0 ? 0.0
                                                          : static_cast<double>(state_.iterations) /
                                                                static_cast<double>(options_.iterations);
    const double of_time = options_.seconds <= 0.0 ? 0.0 : state_.seconds / options_.seconds;
    return std::max(of_iterations, of_time);
  }

  Status iterate() {
    const std::size_t index = rounds_.next();
    const ScenePicture& picture = *pictures_[index];
    geometry::RigidTransform camera_from_map = picture.map_from_camera.inverse();
    camera_from_map.translation_m *= scale_;
    mapping::TrainingView view;
    EDGESPLAT_TRY(view.view, splat::View::from(picture.camera, camera_from_map));
    sensor::to_unit_floats(picture.picture, colour_);
    view.colour = colour_;
    view.weight = picture.weight;
    if (options_.learn_exposure) view.exposure_key = static_cast<std::uint32_t>(index);
    EDGESPLAT_TRY(const mapping::StepReport report, optimiser_.step(view));
    constexpr double kSmoothing = 0.02;
    state_.loss += (state_.iterations == 0 ? 1.0 : kSmoothing) * (report.loss - state_.loss);
    ++state_.iterations;
    if (state_.iterations % options_.densify_every == 0 && progress() < options_.densify_until) {
      (void)mapping::densify(optimiser_, densify_options(), ids_);
    }
    state_.gaussians = optimiser_.cloud().size();
    return {};
  }

  std::span<const ScenePicture* const> pictures_;
  const TrainingOptions& options_;
  double scale_;
  mapping::Optimiser optimiser_;
  mapping::IdAllocator ids_;
  Rounds rounds_;
  const Clock& clock_;
  std::vector<float> colour_;
  TrainingProgress state_;
};

Status check(std::span<const ScenePicture* const> pictures, const io::PointCloud& points) {
  if (pictures.empty()) return fail(Errc::kInvalidArgument, "no picture to train on");
  if (points.points_m.size() < kLeastPoints) {
    return fail(Errc::kInvalidArgument, "only " + std::to_string(points.points_m.size()) +
                                            " points to start from: give the scene a point cloud "
                                            "(\"ply_file_path\" in its transforms.json)");
  }
  return {};
}

}  // namespace

Status TrainingOptions::validate() const {
  if (iterations == 0 && !(seconds > 0.0)) {
    return fail(Errc::kInvalidConfig, "training has no end: give iterations or seconds");
  }
  if (densify_every == 0) return fail(Errc::kInvalidConfig, "densify_every must not be 0");
  if (sh_degree < 0 || sh_degree > 3) return fail(Errc::kInvalidConfig, "sh_degree must be 0..3");
  return {};
}

Result<TrainedMap> train_map(std::span<const ScenePicture* const> pictures, const io::PointCloud& points,
                             const TrainingOptions& options, const Clock& clock,
                             const std::function<void(const TrainingProgress&)>& tell) {
  EDGESPLAT_TRY_STATUS(options.validate());
  EDGESPLAT_TRY_STATUS(check(pictures, points));
  const double extent = camera_extent(pictures);
  const double scale = kTrainingExtent_m / extent;
  mapping::IdAllocator ids(kOrigin);
  io::PointCloud scaled = points;
  for (Eigen::Vector3f& point : scaled.points_m) point *= static_cast<float>(scale);
  const auto start = gaussians_of_points(scaled, kTrainingExtent_m, options.max_start_points, ids);
  EDGESPLAT_TRY(auto optimiser, mapping::Optimiser::create(optimiser_options(options), clock));
  EDGESPLAT_TRY([[maybe_unused]] const std::size_t added, optimiser.add_rows(start));
  return Training(pictures, options, scale, std::move(optimiser), ids, clock).run(tell);
}

}  // namespace edgesplat::desk
