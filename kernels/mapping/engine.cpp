// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/mapping/engine.hpp"

#include "common/base/check.hpp"
#include "common/sensor/image_values.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <utility>

namespace edgesplat::mapping {
namespace {

constexpr float kMarkedSigmas = 2.0F;
/// A pixel filled so far by others is theirs.
constexpr float kFilledElsewhere = 0.5F;

/// Nothing where `alpha` is that of others is trained on.
void ignore_filled(const std::vector<float>& alpha, StoredView& view) {
  view.ignored.resize(alpha.size());
  for (std::size_t pixel = 0; pixel < alpha.size(); ++pixel) {
    if (alpha[pixel] > kFilledElsewhere) view.ignored[pixel] = true;
  }
}

Eigen::Vector3f mean_of(const gaussian::GaussianCloud& cloud, std::size_t row) {
  return Eigen::Map<const Eigen::Vector3f>(&cloud.means_m[3 * row]);
}

/// The least whole factor that leaves so many pixels.
int shrink_to(std::size_t most_pixels, const geometry::CameraModel& camera) {
  const auto pixels = static_cast<std::size_t>(camera.width_px) * static_cast<std::size_t>(camera.height_px);
  std::size_t shrink = 1;
  while (pixels / (shrink * shrink) > most_pixels) ++shrink;
  return static_cast<int>(shrink);
}

/// Nothing where `mask` is set is trained on; an empty one sets nothing.
void leave_out(const std::vector<bool>& mask, std::vector<float>& weight) {
  for (std::size_t pixel = 0; pixel < mask.size(); ++pixel) {
    if (mask[pixel]) weight[pixel] = 0.0F;
  }
}

}  // namespace

Result<std::unique_ptr<MappingEngine>> MappingEngine::create(const EngineOptions& options, IdAllocator& ids,
                                                             const Clock& clock) {
  EDGESPLAT_TRY(Optimiser optimiser, Optimiser::create(options.optimiser, clock));
  return std::unique_ptr<MappingEngine>(new MappingEngine(options, ids, std::move(optimiser)));
}

Result<std::size_t> MappingEngine::restore(const gaussian::GaussianCloud& cloud) {
  EDGESPLAT_TRY(const std::size_t restored, optimiser_.add_rows(cloud));
  seeder_.cover(optimiser_.cloud());
  return restored;
}

Result<std::size_t> MappingEngine::add(const map::Keyframe& keyframe,
                                       const geometry::RigidTransform& map_from_body,
                                       const sensor::ImageRgb8* picture) {
  SeedInput input;
  input.points_in_body = keyframe.points_in_body;
  input.map_from_body = map_from_body;
  input.anchor = {keyframe.id.value, keyframe.pose_version};
  input.has_camera = keyframe.camera.has_value();
  if (picture == nullptr || !keyframe.camera) return seed(input);
  auto view = make_view(keyframe, map_from_body, *picture, undistorter_of(keyframe.camera->model));
  if (!view) {
    EDGESPLAT_TRY_STATUS(seed(input));
    return tl::unexpected(std::move(view).error());
  }
  const auto floor = find_ground(input.points_in_body, map_from_body, options_.fill.ground);
  if (floor) ground_ = floor;
  std::vector<map::ColouredPoint> still;
  if (options_.moving.enabled) {
    EDGESPLAT_TRY(still, without_moving(input, *view));
    input.points_in_body = still;
  }
  EDGESPLAT_TRY(std::size_t added, seed(input));
  if (options_.seen_through.enabled) EDGESPLAT_TRY_STATUS(forget_what_is_gone(*view));
  std::vector<float> elsewhere_alpha;
  if (elsewhere_ && elsewhere_->size() > 0) {
    EDGESPLAT_TRY(elsewhere_alpha, draw_alpha(*view, *elsewhere_, {}));
    ignore_filled(elsewhere_alpha, *view);
  }
  if (options_.fill.enabled && ground_) {
    EDGESPLAT_TRY(const std::size_t filled, fill_floor(*view, input, elsewhere_alpha));
    added += filled;
  }
  if (options_.sweep.enabled) {
    EDGESPLAT_TRY(const std::size_t filled, fill_by_sweep(*view, input, elsewhere_alpha));
    added += filled;
  }
  views_.add(*std::move(view));
  steps_since_view_ = 0;
  return added;
}

Result<std::vector<map::ColouredPoint>> MappingEngine::without_moving(const SeedInput& input,
                                                                      StoredView& view) {
  const MovingOptions& options = options_.moving;
  const GroundPlane* floor = ground_ ? &*ground_ : nullptr;
  const DepthPicture here(view);
  MovingMask in_new(view);
  std::deque<StoredView>& views = views_.views();
  std::vector<std::uint32_t> gone;
  for (std::size_t i = views.size() - std::min(options.views, views.size()); i < views.size(); ++i) {
    for (const SparseDepth& d : moving_depths(view, DepthPicture(views[i]), options.by))
      in_new.mark(d, floor, options);
    MovingMask in_old(views[i]);
    for (const SparseDepth& d : moving_depths(views[i], here, options.by)) in_old.mark(d, floor, options);
    in_old.hide_in(views[i]);
    for (std::uint32_t row = 0; !in_old.empty() && row < cloud().size(); ++row) {
      if (cloud().anchors[row].keyframe == views[i].keyframe.value &&
          in_old.holds(mean_of(cloud(), row), options.thickness_m))
        gone.push_back(row);
    }
  }
  in_new.hide_in(view);
  std::sort(gone.begin(), gone.end());  // each once: a Gaussian has one anchor
  EDGESPLAT_TRY_STATUS(remove_gone(gone));
  std::vector<map::ColouredPoint> still;
  for (const map::ColouredPoint& point : input.points_in_body) {
    const Eigen::Vector3d p_in_map_m = input.map_from_body * point.p_in_body_m.cast<double>();
    if (!in_new.hides(p_in_map_m.cast<float>(), options.thickness_m)) still.push_back(point);
  }
  return still;
}

Result<std::size_t> MappingEngine::seed(const SeedInput& input) {
  const gaussian::GaussianCloud seeded = seeder_.seed(input);
  if (options_.keep_seeds) {
    for (std::size_t row = 0; row < seeded.size(); ++row) seeds_.append_row(seeded, row);
  }
  return optimiser_.add_rows(seeded);
}

Status MappingEngine::forget_what_is_gone(const StoredView& view) {
  const std::vector<std::uint32_t> rows = seen_through_.take(view, cloud());
  std::unordered_map<std::uint32_t, MovingMask> masks;  // by the keyframe that showed it
  for (const StoredView& old : views_.views()) masks.emplace(old.keyframe.value, old);
  for (const std::uint32_t row : rows) {
    const auto showed_it = masks.find(cloud().anchors[row].keyframe);
    if (showed_it == masks.end()) continue;
    const float* log_scales = &cloud().log_scales[3 * std::size_t{row}];
    const float sigma_m = std::exp(std::max({log_scales[0], log_scales[1], log_scales[2]}));
    showed_it->second.mark(mean_of(cloud(), row), kMarkedSigmas * sigma_m);
  }
  for (StoredView& old : views_.views()) masks.at(old.keyframe.value).hide_in(old);
  return remove_gone(rows);
}

Status MappingEngine::remove_gone(std::span<const std::uint32_t> rows) {
  for (const std::uint32_t row : rows) removed_.push_back(cloud().ids[row]);
  gone_ += rows.size();
  return optimiser_.remove_rows(rows);
}

void MappingEngine::set_elsewhere(std::shared_ptr<const gaussian::GaussianCloud> elsewhere) {
  elsewhere_ = std::move(elsewhere);
  if (elsewhere_) seeder_.cover(*elsewhere_);
}

std::shared_ptr<const image::Undistorter> MappingEngine::undistorter_of(const geometry::CameraModel& camera) {
  if (!camera_ || !(*camera_ == camera)) {
    camera_ = camera;
    undistorter_ =
        std::make_shared<const image::Undistorter>(camera, shrink_to(options_.most_pixels, camera));
  }
  return undistorter_;
}

bool MappingEngine::has_work() const {
  return views_.size() > 0 &&
         steps_since_view_ < views_.size() * static_cast<std::uint64_t>(options_.steps_per_view);
}

TrainingView MappingEngine::prepare(const StoredView& view) {
  sensor::to_unit_floats(view.picture, colour_);
  depth_m_.assign(colour_.size() / 3, 0.0F);
  for (const SparseDepth& d : view.depths) depth_m_[d.pixel] = d.depth_m;
  TrainingView training;
  auto drawn_from = splat::View::from(view.camera(), view.map_from_camera.inverse());
  EDGESPLAT_CHECK(drawn_from.has_value(), "an undistorted camera and a checked pose");
  training.view = *drawn_from;
  training.colour = colour_;
  training.depth_m = depth_m_;
  training.weight = view.undistorter->seen();
  if (!view.ignored.empty() || !view.unmapped.empty()) {
    weight_.assign(training.weight.begin(), training.weight.end());
    leave_out(view.ignored, weight_);
    leave_out(view.unmapped, weight_);
    training.weight = weight_;
  }
  if (!view.exposure_known) training.exposure_key = view.keyframe.value;
  return training;
}

std::optional<StepReport> MappingEngine::step() {
  const StoredView* view = views_.next();
  if (view == nullptr) return std::nullopt;
  auto report = optimiser_.step(prepare(*view));
  EDGESPLAT_CHECK(report.has_value(), "a prepared view fits itself");
  ++steps_;
  ++steps_since_view_;
  if (options_.densify_every > 0 && steps_ % static_cast<std::uint64_t>(options_.densify_every) == 0) {
    const DensifyReport grown = densify(optimiser_, options_.densify, ids_);
    removed_.insert(removed_.end(), grown.removed.begin(), grown.removed.end());
  }
  return *report;
}

EngineChanges MappingEngine::take_changes() {
  EngineChanges changes{optimiser_.changed_since(taken_), std::move(removed_)};
  removed_.clear();
  taken_ = optimiser_.mark();
  return changes;
}

}  // namespace edgesplat::mapping
