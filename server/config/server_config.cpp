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

}  // namespace

void describe(ConfigReader& reader, ServerConfig& config) {
  reader.field("log_level", config.log_level, "trace, debug, info, warn, error or off");
  if (!log::parse_level(config.log_level)) {
    reader.problem("log_level", "is none of trace, debug, info, warn, error, off");
  }
  reader.field("instance_id", config.instance_id, {1, 65535}, "origin of the Gaussians this server makes");
  reader.field("max_robots", config.max_robots, {1, 64}, "served at a time");
  reader.field("queue_keyframes", config.queue_keyframes, {1, 1024}, "decoded and waiting to be mapped");
  reader.field("delta_gaussians", config.delta_gaussians, {1, 65536}, "most Gaussians in one delta");
  reader.field("heartbeat_period_s", config.heartbeat_period_s, Range{0.05, 10.0}, "time between heartbeats");
  reader.table("link", "the way to the robots", [&] { describe(reader, config.link); });
  reader.table("seed", "new Gaussians from LiDAR points", [&] { describe_seed(reader, config.seed); });
}

}  // namespace edgesplat::config
