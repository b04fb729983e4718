// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/desk/training.hpp"

#include "common/sensor/image_values.hpp"
#include "kernels/mapping/densify.hpp"
#include "kernels/mapping/optimiser.hpp"
#include "kernels/mapping/relocate.hpp"
#include "tools/desk/picture_stages.hpp"
#include "tools/desk/scene_start.hpp"
#include "tools/desk/start_gaps.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace edgesplat::desk {
namespace {

/// The optimiser's defaults are for scenes in metres: scenes are scaled to this extent while they are
/// trained.
constexpr double kTrainingExtent_m = 5.0;
constexpr std::size_t kLeastPoints = 10;
constexpr std::uint16_t kOrigin = 1;

mapping::OptimiserOptions optimiser_options(const TrainingOptions& options, std::size_t max_gaussians) {
  mapping::OptimiserOptions out;
  out.sh_degree = mapping::Schedule(options.schedule).sh_degree(0.0);
  out.max_gaussians = max_gaussians;
  out.rates.mean_m = 1.6e-4F * static_cast<float>(kTrainingExtent_m);
  out.rates.opacity_logit = 5e-2F;
  out.rates = mapping::scaled(out.rates, options.rate_factor);
  out.depth_factor = options.depth_factor;
  out.opacity_factor = options.opacity_factor;
  out.scale_factor = options.scale_factor / static_cast<float>(kTrainingExtent_m);
  out.prune.factor = options.prune_factor;
  out.exposure.rate = options.learn_exposure ? 1e-3F : 0.0F;
  return out;
}

mapping::DensifyOptions densify_options(std::size_t most_rows) {
  mapping::DensifyOptions out;
  out.max_rows = most_rows;
  out.split_sigma_m = 0.01F * static_cast<float>(kTrainingExtent_m);
  out.gradient = 1e-4F;
  out.grow_share = 0.3F;
  out.max_sigma_m = 0.5F * static_cast<float>(kTrainingExtent_m);
  return out;
}

mapping::RelocateOptions relocate_options() {
  mapping::RelocateOptions out;
  out.max_sigma_m = 0.5F * static_cast<float>(kTrainingExtent_m);
  // 5e5 times the means' rate in the paper, where a scene's extent is 1.
  out.noise_per_m = 5e5F * 1.6e-4F / static_cast<float>(kTrainingExtent_m);
  return out;
}

class Training {
 public:
  Training(std::span<const ScenePicture* const> pictures, const TrainingOptions& options, double scale,
           mapping::Optimiser optimiser, mapping::IdAllocator ids, const Clock& clock, double start_s)
      : pictures_(pictures),
        options_(options),
        schedule_(options.schedule),
        rates_(optimiser.options().rates),
        scale_(scale),
        optimiser_(std::move(optimiser)),
        ids_(ids),
        relocator_(relocate_options()),
        order_(pictures.size(), options.views),
        start_rows_(optimiser_.cloud().size()),
        clock_(clock) {
    state_.seconds = start_s;
  }

  Result<TrainedMap> run(const TrainingWatch& watch) {
    double told_s = 0.0;
    std::size_t looked = 0;  // at times of the watch
    while (progress() < 1.0) {
      const HostTime begin = clock_.now();
      EDGESPLAT_TRY_STATUS(iterate());
      state_.seconds += to_seconds(clock_.now() - begin);
      if (watch.tell && state_.seconds >= told_s + 1.0) {
        told_s = state_.seconds;
        watch.tell(state_);
      }
      const std::size_t before = looked;
      while (looked < watch.look_at_s.size() && watch.look_at_s[looked] <= state_.seconds) ++looked;
      if (watch.look && looked > before && progress() < 1.0) {
        EDGESPLAT_TRY_STATUS(watch.look(state_, map_in_scene()));
      }
    }
    if (watch.tell) watch.tell(state_);
    TrainedMap out{map_in_scene(), state_.iterations, state_.seconds};
    if (watch.look) {
      EDGESPLAT_TRY_STATUS(watch.look(state_, out.map));
    }
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

  /// As it is now, in the scene's units.
  [[nodiscard]] gaussian::GaussianCloud map_in_scene() const {
    gaussian::GaussianCloud map = optimiser_.cloud();
    const auto back = static_cast<float>(1.0 / scale_);
    for (float& value : map.means_m) value *= back;
    for (float& value : map.log_scales) value += std::log(back);
    return map;
  }

  /// Brings the optimiser to where the schedule is.
  Status follow_schedule() {
    const double now = progress();
    EDGESPLAT_TRY_STATUS(optimiser_.raise_sh_degree(schedule_.sh_degree(now)));
    optimiser_.set_rates(mapping::scaled(rates_, schedule_.rate_share(now)));
    const bool coarse = state_.iterations < options_.coarse_rounds * pictures_.size();
    const int shrink = coarse ? schedule_.shrink(now) : 1;
    if (shrink < shrink_) pictures_.forget_small();
    shrink_ = shrink;
    return {};
  }

  /// The view of a picture; `colour_` and `depth_m_` hold its values.
  Result<mapping::TrainingView> view_of(std::size_t index) {
    const ScenePicture& picture = pictures_.at(index, shrink_);
    geometry::RigidTransform camera_from_map = picture.map_from_camera.inverse();
    camera_from_map.translation_m *= scale_;
    mapping::TrainingView view;
    EDGESPLAT_TRY(view.view, splat::View::from(picture.camera, camera_from_map));
    sensor::to_unit_floats(picture.picture, colour_);
    view.colour = colour_;
    view.weight = picture.weight;
    if (options_.depth_factor > 0.0F && !picture.depth_m.empty()) {
      depth_m_ = picture.depth_m;
      for (float& depth_m : depth_m_) depth_m *= static_cast<float>(scale_);
      view.depth_m = depth_m_;
    }
    if (options_.learn_exposure) view.exposure_key = static_cast<std::uint32_t>(index);
    return view;
  }

  /// How large the map shall become. Where its owner does not say, no larger than its pictures are worth, nor
  /// than the steps that there is time for can fit.
  [[nodiscard]] std::size_t final_rows() const {
    if (options_.max_gaussians > 0) return options_.max_gaussians;
    constexpr double kRowsAStep = 40.0, kLeastGrowth = 1.5;
    const double steps = static_cast<double>(state_.iterations) / std::max(1e-9, progress());
    const double most = std::max(kLeastGrowth * static_cast<double>(start_rows_), kRowsAStep * steps);
    return std::min(optimiser_.options().max_gaussians, static_cast<std::size_t>(most));
  }

  /// How large the map may be now: it grows by the same factor in equal times.
  [[nodiscard]] std::size_t most_rows() const {
    const double way = std::min(1.0, progress() / std::max(1e-9, 0.8 * options_.schedule.grow_until));
    const double factor = static_cast<double>(final_rows()) / static_cast<double>(start_rows_);
    return std::min(final_rows(), static_cast<std::size_t>(static_cast<double>(start_rows_) *
                                                           std::pow(std::max(1.0, factor), way)));
  }

  void densify() {
    if (options_.densify == Densify::kGradient) {
      (void)mapping::densify(optimiser_, densify_options(most_rows()), ids_);
    } else {
      relocator_.set_growth(1.0F, most_rows());
      (void)relocator_.relocate(optimiser_, ids_);
    }
  }

  Status iterate() {
    EDGESPLAT_TRY_STATUS(follow_schedule());
    const std::size_t index = order_.next();
    EDGESPLAT_TRY(const mapping::TrainingView view, view_of(index));
    EDGESPLAT_TRY(const mapping::StepReport report, optimiser_.step(view));
    order_.tell(index, report.loss);
    if (options_.densify == Densify::kMcmc) relocator_.shake(optimiser_, schedule_.rate_share(progress()));
    constexpr double kSmoothing = 0.02;
    state_.loss += (state_.iterations == 0 ? 1.0 : kSmoothing) * (report.loss - state_.loss);
    ++state_.iterations;
    if (state_.iterations % options_.densify_every == 0 && schedule_.grows(progress())) densify();
    state_.gaussians = optimiser_.cloud().size();
    return {};
  }

  PictureStages pictures_;
  const TrainingOptions& options_;
  mapping::Schedule schedule_;
  train::LearningRates rates_;  ///< at the start
  double scale_;
  mapping::Optimiser optimiser_;
  mapping::IdAllocator ids_;
  mapping::Relocator relocator_;
  mapping::ViewOrder order_;
  int shrink_ = 1;
  std::size_t start_rows_;
  const Clock& clock_;
  std::vector<float> colour_, depth_m_;
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

/// As TrainingOptions::max_gaussians says.
std::size_t gaussians_for(std::span<const ScenePicture* const> pictures) {
  constexpr std::size_t kPixelsEach = 48, kLeast = 5'000, kMost = 300'000;
  std::size_t pixels = 0;
  for (const ScenePicture* picture : pictures) pixels += picture->picture.values.size() / 3;
  return std::clamp(pixels / kPixelsEach, kLeast, kMost);
}

/// What training starts with: the points, and what they leave out.
Status add_start(std::span<const ScenePicture* const> pictures, const io::PointCloud& points, double scale,
                 const TrainingOptions& options, mapping::IdAllocator& ids, mapping::Optimiser& optimiser) {
  io::PointCloud scaled = points;
  for (Eigen::Vector3f& point : scaled.points_m) point *= static_cast<float>(scale);
  const std::size_t most = std::min(options.max_start_points, 3 * optimiser.room() / 4);
  const auto start = gaussians_of_points(scaled, {kTrainingExtent_m, most, options.start_opacity}, ids);
  EDGESPLAT_TRY([[maybe_unused]] const std::size_t added, optimiser.add_rows(start));
  if (!options.fill_gaps) return {};
  constexpr std::size_t kAlways = 5'000;
  const std::size_t most_in_gaps = std::min(optimiser.room() / 2, std::max(start.size() / 2, kAlways));
  const GapOptions gaps{scale, most_in_gaps, options.start_opacity};
  EDGESPLAT_TRY(const auto filled, gaussians_in_gaps(pictures, start, gaps, ids));
  EDGESPLAT_TRY([[maybe_unused]] const std::size_t more, optimiser.add_rows(filled));
  return {};
}

}  // namespace

Status TrainingOptions::validate() const {
  if (iterations == 0 && !(seconds > 0.0)) {
    return fail(Errc::kInvalidConfig, "training has no end: give iterations or seconds");
  }
  if (densify_every == 0) return fail(Errc::kInvalidConfig, "densify_every must not be 0");
  if (!(start_opacity >= 0.01F && start_opacity <= 0.9F)) {
    return fail(Errc::kInvalidConfig, "start_opacity must be 0.01..0.9");
  }
  if (!(rate_factor >= 0.1F && rate_factor <= 10.0F)) {
    return fail(Errc::kInvalidConfig, "rate_factor must be 0.1..10");
  }
  if (!(views.loss_share >= 0.0F && views.loss_share <= 10.0F)) {
    return fail(Errc::kInvalidConfig, "views.loss_share must be 0..10");
  }
  return schedule.validate();
}

Result<TrainedMap> train_map(std::span<const ScenePicture* const> pictures, const io::PointCloud& points,
                             const TrainingOptions& options, const Clock& clock, const TrainingWatch& watch) {
  EDGESPLAT_TRY_STATUS(options.validate());
  EDGESPLAT_TRY_STATUS(check(pictures, points));
  const double extent = camera_extent(pictures);
  const double scale = kTrainingExtent_m / extent;
  mapping::IdAllocator ids(kOrigin);
  const HostTime begin = clock.now();
  const std::size_t budget = options.max_gaussians > 0 ? options.max_gaussians : gaussians_for(pictures);
  EDGESPLAT_TRY(auto optimiser, mapping::Optimiser::create(optimiser_options(options, budget), clock));
  EDGESPLAT_TRY_STATUS(add_start(pictures, points, scale, options, ids, optimiser));
  const double start_s = to_seconds(clock.now() - begin);
  return Training(pictures, options, scale, std::move(optimiser), ids, clock, start_s).run(watch);
}

}  // namespace edgesplat::desk
