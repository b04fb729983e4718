// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/mapping/engine.hpp"

#include "common/base/check.hpp"

#include <algorithm>
#include <utility>

namespace edgesplat::mapping {

Result<std::unique_ptr<MappingEngine>> MappingEngine::create(const EngineOptions& options, IdAllocator& ids,
                                                             const Clock& clock) {
  EDGESPLAT_TRY(Optimiser optimiser, Optimiser::create(options.optimiser, clock));
  return std::unique_ptr<MappingEngine>(new MappingEngine(options, ids, std::move(optimiser)));
}

Result<std::size_t> MappingEngine::add(const map::Keyframe& keyframe,
                                       const geometry::RigidTransform& map_from_body,
                                       const sensor::ImageRgb8* picture) {
  EDGESPLAT_TRY(const std::size_t added, seed(keyframe, map_from_body));
  if (picture == nullptr || !keyframe.camera) return added;
  EDGESPLAT_TRY(StoredView view,
                make_view(keyframe, map_from_body, *picture, undistorter_of(keyframe.camera->model)));
  views_.add(std::move(view));
  steps_since_view_ = 0;
  return added;
}

Result<std::size_t> MappingEngine::seed(const map::Keyframe& keyframe,
                                        const geometry::RigidTransform& map_from_body) {
  SeedInput input;
  input.points_in_body = keyframe.points_in_body;
  input.map_from_body = map_from_body;
  input.anchor = {keyframe.id.value, keyframe.pose_version};
  input.has_camera = keyframe.camera.has_value();
  const gaussian::GaussianCloud seeded = seeder_.seed(input);
  if (options_.keep_seeds) {
    for (std::size_t row = 0; row < seeded.size(); ++row) seeds_.append_row(seeded, row);
  }
  return optimiser_.add_rows(seeded);
}

std::shared_ptr<const image::Undistorter> MappingEngine::undistorter_of(const geometry::CameraModel& camera) {
  if (!camera_ || !(*camera_ == camera)) {
    camera_ = camera;
    undistorter_ = std::make_shared<const image::Undistorter>(camera);
  }
  return undistorter_;
}

bool MappingEngine::has_work() const {
  return views_.size() > 0 &&
         steps_since_view_ < views_.size() * static_cast<std::uint64_t>(options_.steps_per_view);
}

TrainingView MappingEngine::prepare(const StoredView& view) {
  colour_.resize(view.picture.values.size());
  std::transform(view.picture.values.begin(), view.picture.values.end(), colour_.begin(),
                 [](std::uint8_t v) { return static_cast<float>(v) * (1.0F / 255.0F); });
  depth_m_.assign(colour_.size() / 3, 0.0F);
  for (const SparseDepth& d : view.depths) depth_m_[d.pixel] = d.depth_m;
  TrainingView training;
  auto drawn_from = splat::View::from(view.camera(), view.map_from_camera.inverse());
  EDGESPLAT_CHECK(drawn_from.has_value(), "an undistorted camera and a checked pose");
  training.view = *drawn_from;
  training.colour = colour_;
  training.depth_m = depth_m_;
  training.weight = view.undistorter->seen();
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
