// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "server/config/server_config.hpp"

#include "common/log/log.hpp"

namespace edgesplat::config {
namespace {

void describe_seed(ConfigReader& reader, mapping::SeedOptions& seed) {
  reader.field("near_cell_m", seed.coverage.near_cell_m, Range{0.02, 1.0},
               "finest distance between new Gaussians");
  reader.field("cell_per_range", seed.coverage.cell_per_range, Range{0.0, 0.1},
               "distance between new Gaussians over the range they are seen from");
  reader.field("max_range_m", seed.max_range_m, Range{1.0, 500.0}, "farther points are left out");
  reader.field("opacity", seed.opacity, Range{0.05, 0.99}, "of a new Gaussian");
  reader.field("sigma_per_spacing", seed.sigma_per_spacing, Range{0.2, 2.0},
               "size of a Gaussian over the distance to its neighbours");
  reader.field("min_sigma_m", seed.min_sigma_m, Range{0.001, 0.1}, "smallest size");
  reader.field("max_sigma_m", seed.max_sigma_m, Range{0.05, 5.0}, "largest size");
  reader.field("flat_ratio", seed.flat_ratio, Range{0.01, 1.0}, "thickness over width on planes");
  reader.field("plane_max_ratio", seed.plane_max_ratio, Range{0.0, 1.0},
               "smallest over middle eigenvalue of a neighbourhood that counts as a plane");
}

void describe_optimise(ConfigReader& reader, OptimiseConfig& optimise) {
  mapping::EngineOptions& engine = optimise.engine;
  reader.field("enabled", optimise.enabled, "off: maps stay as they are seeded");
  reader.field("publish_period_s", optimise.publish_period_s, Range{0.02, 10.0},
               "between two times that a robot is told what changed");
  reader.field("delta_bytes_per_s", optimise.delta_bytes_per_s, Range{1e3, 1e9},
               "mean that a robot is sent at most");
  reader.field("steps_per_view", engine.steps_per_view, Range{1, 1'000'000},
               "a map without new views rests after so many steps a view");
  reader.field("keep_seeds", engine.keep_seeds, "also keep maps as they were seeded, to compare with");
  reader.field("fill_holes", engine.fill.enabled,
               "seed the floor and feet of walls where only the camera looks");
  reader.field("fill_by_sweep", engine.sweep.enabled,
               "seed what only the camera sees, as far away as the pictures tell");
  reader.field("most_pixels", engine.most_pixels, Range<std::size_t>{1000, 1'000'000'000},
               "larger pictures are trained on at half, a third, ... of their size");
  reader.field("forget_seen_through", engine.seen_through.enabled,
               "remove what the LiDAR measures something behind");
  reader.field("hide_moving", engine.moving.enabled,
               "leave out of the map what stands where another view saw nothing");
  reader.field("max_view_bytes", engine.views.max_bytes, Range<std::size_t>{1'000'000, std::size_t{1} << 40U},
               "memory for the pictures to train on");
  reader.field("recent_views", engine.views.recent, Range<std::size_t>{0, 1000},
               "newest views, that get more steps");
  reader.field("recent_share", engine.views.recent_share, Range{0.0, 1.0},
               "of the steps, for the newest views");
  mapping::OptimiserOptions& optimiser = engine.optimiser;
  reader.field("sh_degree", optimiser.sh_degree, Range{0, 3}, "of the colours");
  reader.field("max_gaussians", optimiser.max_gaussians, Range<std::size_t>{1, std::size_t{1} << 31U},
               "of one robot's map");
  reader.field("ssim_share", optimiser.ssim_share, Range{0.0, 1.0}, "of the colour loss");
  reader.field("depth_factor", optimiser.depth_factor, Range{0.0, 1.0},
               "of the depth loss beside the colour loss");
  reader.field("gap_factor", optimiser.gap_factor, Range{0.0, 1.0},
               "of the mean transparency of the pixels in the loss");
  reader.field("opacity_factor", optimiser.opacity_factor, Range{0.0, 0.1},
               "of the mean opacity in the loss");
  reader.field("scale_factor", optimiser.scale_factor, Range{0.0, 0.1}, "of the mean size in the loss");
  reader.field("densify_every", engine.densify_every, Range{0, 100'000},
               "steps between growing and pruning; 0: never");
  reader.field("densify_gradient", engine.densify.gradient, Range{1e-5, 1e-2},
               "above it a Gaussian is cloned or split");
  reader.field("densify_split_sigma_m", engine.densify.split_sigma_m, Range{0.001, 1.0},
               "longer ones are split");
  reader.field("prune_opacity", engine.densify.min_opacity, Range{0.0, 0.7},
               "below it a Gaussian is removed");
  reader.table("rates", "step sizes", [&] {
    train::LearningRates& rates = optimiser.rates;
    reader.field("mean_m", rates.mean_m, Range{0.0, 0.1}, "of the place, metres");
    reader.field("log_scale", rates.log_scale, Range{0.0, 0.2}, "of the logarithm of the size");
    reader.field("quat", rates.quat, Range{0.0, 0.2}, "of the quaternion");
    reader.field("opacity_logit", rates.opacity_logit, Range{0.0, 0.5}, "of the opacity's logit");
    reader.field("sh_base", rates.sh_base, Range{0.0, 0.2}, "of the colour");
    reader.field("sh_rest", rates.sh_rest, Range{0.0, 0.2}, "of the colour's dependence on direction");
  });
}

void describe_store(ConfigReader& reader, StoreConfig& store) {
  reader.field("enabled", store.enabled, "off: neither keyframes nor maps are written");
  reader.field("folder", store.folder, "under DIR/server of the run, unless it begins with /");
  reader.field("save_period_s", store.save_period_s, Range{0.1, 3600.0},
               "between two times that a map is saved");
  reader.field("max_megabytes", store.max_megabytes, Range<std::size_t>{1, 1'000'000},
               "of keyframes; the oldest go first");
  reader.field("queue_keyframes", store.queue_keyframes, Range<std::size_t>{1, 4096},
               "waiting for the disk; full: the newest are left out");
}

}  // namespace

void describe(ConfigReader& reader, ServerConfig& config) {
  reader.field("log_level", config.log_level, "trace, debug, info, warn, error or off");
  if (!log::parse_level(config.log_level)) {
    reader.problem("log_level", "is none of trace, debug, info, warn, error, off");
  }
  reader.field("instance_id", config.instance_id, {32768, 65535},
               "origin of the Gaussians this server makes; below are the robots' numbers");
  reader.field("max_robots", config.max_robots, {1, 64}, "served at a time");
  reader.field("queue_keyframes", config.queue_keyframes, {1, 1024}, "decoded and waiting to be mapped");
  reader.field("delta_gaussians", config.delta_gaussians, {1, 65536}, "most Gaussians in one delta");
  reader.field("heartbeat_period_s", config.heartbeat_period_s, Range{0.05, 10.0}, "time between heartbeats");
  reader.table("link", "the way to the robots", [&] { describe(reader, config.link); });
  reader.table("seed", "new Gaussians from LiDAR points",
               [&] { describe_seed(reader, config.optimise.engine.seed); });
  reader.table("optimise", "what makes them look like the pictures",
               [&] { describe_optimise(reader, config.optimise); });
  reader.table("store", "what outlives the server", [&] { describe_store(reader, config.store); });
}

}  // namespace edgesplat::config
