// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "server/optimise/map_builder.hpp"

#include <algorithm>
#include <numeric>

namespace edgesplat::optimise {
namespace {

map::ChunkId birth_chunk(const gaussian::GaussianCloud& cloud, std::size_t row) {
  return map::chunk_of({cloud.means_m[3 * row], cloud.means_m[3 * row + 1], cloud.means_m[3 * row + 2]});
}

}  // namespace

MapChange MapBuilder::add(const map::Keyframe& keyframe) {
  mapping::SeedInput input;
  input.points_in_body = keyframe.points_in_body;
  input.map_from_body = keyframe.odom_from_body;
  input.anchor = {keyframe.id.value, keyframe.pose_version};
  input.has_camera = keyframe.camera.has_value();
  const gaussian::GaussianCloud seeded = seeder_.seed(input);

  // By chunk, in the order of birth within one: what the wire and the robot's memory want.
  std::vector<map::ChunkId> chunks(seeded.size());
  for (std::size_t row = 0; row < seeded.size(); ++row) chunks[row] = birth_chunk(seeded, row);
  std::vector<std::size_t> order(seeded.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return chunks[a] < chunks[b]; });
  MapChange change;
  change.chunks.reserve(seeded.size());
  for (const std::size_t row : order) {
    change.added.append_row(seeded, row);
    change.chunks.push_back(chunks[row]);
    gaussians_.append_row(seeded, row);
    hash_.add(chunks[row], map::record_digest(seeded, row));
  }
  return change;
}

}  // namespace edgesplat::optimise
