// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "server/optimise/map_builder.hpp"

#include "common/io/keyframe_picture.hpp"
#include "common/log/log.hpp"

#include <utility>

namespace edgesplat::optimise {

Result<std::unique_ptr<MapBuilder>> MapBuilder::create(const mapping::EngineOptions& options,
                                                       mapping::IdAllocator& ids, const Clock& clock) {
  EDGESPLAT_TRY(auto engine, mapping::MappingEngine::create(options, ids, clock));
  return std::unique_ptr<MapBuilder>(new MapBuilder(std::move(engine)));
}

Result<std::size_t> MapBuilder::restore(const gaussian::GaussianCloud& cloud,
                                        std::vector<KeyframePose> poses) {
  EDGESPLAT_TRY(const std::size_t restored, engine_->restore(cloud));
  poses_ = std::move(poses);
  return restored;
}

std::size_t MapBuilder::add(const map::Keyframe& keyframe) {
  const auto picture = io::decode_picture(keyframe);
  if (!picture) {
    ++bad_pictures_;
    EDGESPLAT_LOG_WARN("map", "keyframe's picture not used", "keyframe", keyframe.id.value, "why",
                       picture.error().context);
  }
  if (!engine_->gpu_failure().empty() && !std::exchange(told_of_gpu_, true))
    EDGESPLAT_LOG_WARN("map", "optimising on the CPU", "why", engine_->gpu_failure());
  const bool shows = picture && picture->has_value();
  const auto added = engine_->add(keyframe, keyframe.odom_from_body, shows ? &**picture : nullptr);
  if (added) {
    poses_.push_back({keyframe.id, keyframe.pose_version, keyframe.odom_from_body});
    return *added;
  }
  EDGESPLAT_LOG_ERROR("map", "keyframe not mapped", "keyframe", keyframe.id.value, "why",
                      added.error().context);
  return 0;
}

}  // namespace edgesplat::optimise
