// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/local_mapping/local_map.hpp"

#include "common/base/check.hpp"
#include "common/io/keyframe_picture.hpp"
#include "common/log/log.hpp"
#include "robot/local_mapping/importance.hpp"

#include <malloc.h>

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

namespace edgesplat::local_mapping {
namespace {

constexpr std::size_t kAllViews = std::numeric_limits<std::size_t>::max();
constexpr std::size_t kMostOvertaken = 256;

mapping::EngineOptions engine_options(const LocalMappingConfig& config) {
  mapping::EngineOptions options;
  options.views.max_bytes = config.view_bytes();
  return options;
}

/// The cloud's memory in training, and twice outside: as published and as drawn.
std::size_t bytes_each(const mapping::Optimiser& optimiser) {
  constexpr std::size_t kFloats_bytes = 4 * (3 + 3 + 4 + 1 + 3);
  return optimiser.bytes_per_row() +
         2 * (kFloats_bytes + sizeof(gaussian::GaussianId) + sizeof(gaussian::Anchor));
}

gaussian::GaussianCloud without(const gaussian::GaussianCloud& cloud, std::span<const std::uint32_t> rows) {
  gaussian::GaussianCloud rest;
  rest.sh_degree = cloud.sh_degree;
  auto gone = rows.begin();
  for (std::uint32_t row = 0; row < cloud.size(); ++row) {
    if (gone != rows.end() && *gone == row) {
      ++gone;
    } else {
      rest.append_row(cloud, row);
    }
  }
  return rest;
}

}  // namespace

Result<LocalMap> LocalMap::create(const LocalMappingConfig& config, map::RobotId robot, const Clock& clock) {
  mapping::EngineOptions options = engine_options(config);
  EDGESPLAT_TRY(const auto probe, mapping::Optimiser::create(options.optimiser, clock));
  options.optimiser.max_gaussians = std::max<std::size_t>(1, config.gaussian_bytes() / bytes_each(probe));
  EDGESPLAT_TRY_STATUS(options.optimiser.validate());
  return LocalMap(config, options, robot, clock);
}

LocalMap::LocalMap(const LocalMappingConfig& config, const mapping::EngineOptions& options,
                   map::RobotId robot, const Clock& clock)
    : config_(config),
      options_(options),
      clock_(&clock),
      ids_(std::make_unique<mapping::IdAllocator>(robot.value)),
      room_(options.optimiser.max_gaussians) {}

void LocalMap::set_here(bool map_here) {
  if (map_here == here()) return;
  if (map_here) {
    begin(std::exchange(kept_, {}), {});
    return;
  }
  kept_ = engine_->cloud();
  engine_.reset();
}

void LocalMap::begin(const gaussian::GaussianCloud& cloud, std::deque<mapping::StoredView> views) {
  auto engine = mapping::MappingEngine::create(options_, *ids_, *clock_);
  EDGESPLAT_CHECK(engine.has_value(), "the options were checked");
  engine_ = *std::move(engine);
  EDGESPLAT_CHECK(engine_->restore(cloud).has_value(), "Gaussians of an engine alike");
  for (mapping::StoredView& view : views) engine_->add_view(std::move(view));
  resident_new_ = resident_in_odom_ != nullptr;
}

void LocalMap::set_resident(std::shared_ptr<const gaussian::GaussianCloud> in_odom) {
  resident_in_odom_ = std::move(in_odom);
  resident_new_ = true;
}

bool LocalMap::mapped_elsewhere(map::KeyframeId keyframe) {
  const bool overtaken = overtaken_.contains(keyframe.value);
  next_keyframe_ = std::max(next_keyframe_, keyframe.value + 1);
  overtaken_.erase(overtaken_.begin(), overtaken_.lower_bound(next_keyframe_));
  return overtaken;
}

void LocalMap::add(const map::Keyframe& keyframe) {
  if (!here() || mapped_elsewhere(keyframe.id)) return;
  if (std::exchange(resident_new_, false)) engine_->set_elsewhere(resident_in_odom_);
  const auto picture = io::decode_picture(keyframe);
  if (!picture) {
    ++counters_.bad_pictures;
    EDGESPLAT_LOG_WARN("local", "keyframe's picture not used", "keyframe", keyframe.id.value, "why",
                       picture.error().context);
  }
  if (!engine_->gpu_failure().empty() && !std::exchange(told_of_gpu_, true))
    EDGESPLAT_LOG_WARN("local", "optimising on the CPU", "why", engine_->gpu_failure());
  const bool shows = picture && picture->has_value();
  const auto added = engine_->add(keyframe, keyframe.odom_from_body, shows ? &**picture : nullptr);
  ++revision_;
  if (!added) {
    EDGESPLAT_LOG_ERROR("local", "keyframe not mapped", "keyframe", keyframe.id.value, "why",
                        added.error().context);
    return;
  }
  ++counters_.keyframes;
  robot_in_odom_m_ = keyframe.odom_from_body.translation_m.cast<float>();
  // Room for the next ones, from what the robot has left behind.
  if (engine_->cloud().size() > room_ / 10 * 9) keep_at_most(room_ / 4 * 3, kAllViews);
}

void LocalMap::step() {
  if (!has_work() || !engine_->step()) return;
  ++counters_.steps;
  ++revision_;
}

void LocalMap::prune_and_compress() {
  const std::size_t size = cloud().size();
  keep_at_most(std::max(room_ / 20, std::min(room_ / 2, size / 5 * 4)), config_.views_when_short);
  (void)::malloc_trim(0);  // the memory is wanted by others, and what was freed counts until it is returned
}

void LocalMap::keep_at_most(std::size_t gaussians, std::size_t newest_views) {
  const std::size_t size = cloud().size();
  std::vector<std::uint32_t> rows;
  if (size > gaussians) rows = least_important(cloud(), robot_in_odom_m_, size - gaussians);
  const bool many_views = here() && engine_->views().size() > newest_views;
  if (rows.empty() && !many_views) return;
  counters_.pruned += rows.size();
  keep_all_but(rows, newest_views);
}

void LocalMap::keep_all_but(std::span<const std::uint32_t> rows, std::size_t newest_views) {
  gaussian::GaussianCloud rest = without(cloud(), rows);
  ++revision_;
  if (!here()) {
    kept_ = std::move(rest);
    return;
  }
  std::deque<mapping::StoredView> views = engine_->take_views();
  while (views.size() > newest_views) {
    views.pop_front();
    ++counters_.dropped_views;
  }
  engine_.reset();  // with all that its arrays had room for
  begin(rest, std::move(views));
}

void LocalMap::retire(std::span<const std::uint32_t> keyframes) {
  const std::set<std::uint32_t> mapped(keyframes.begin(), keyframes.end());
  overtaken_.insert(mapped.lower_bound(next_keyframe_), mapped.end());
  while (overtaken_.size() > kMostOvertaken) overtaken_.erase(overtaken_.begin());
  std::vector<std::uint32_t> rows;
  for (std::uint32_t row = 0; row < cloud().size(); ++row) {
    if (mapped.contains(cloud().anchors[row].keyframe)) rows.push_back(row);
  }
  if (rows.empty()) return;
  counters_.retired += rows.size();
  // What is left must not learn to look like what the server's Gaussians show from now on: no old pictures.
  keep_all_but(rows, 0);
}

LocalMapCounters LocalMap::counters() const {
  LocalMapCounters counters = counters_;
  counters.gaussians = cloud().size();
  counters.views = here() ? engine_->views().size() : 0;
  return counters;
}

}  // namespace edgesplat::local_mapping
