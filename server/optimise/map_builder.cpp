// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "server/optimise/map_builder.hpp"

namespace edgesplat::optimise {

MapChange MapBuilder::add(const map::Keyframe& keyframe) {
  mapping::SeedInput input;
  input.points_in_body = keyframe.points_in_body;
  input.map_from_body = keyframe.odom_from_body;
  input.anchor = {keyframe.id.value, keyframe.pose_version};
  input.has_camera = keyframe.camera.has_value();
  const gaussian::GaussianCloud seeded = seeder_.seed(input);
  MapChange change;
  for (std::size_t row = 0; row < seeded.size(); ++row) {
    change.changed_rows.push_back(static_cast<std::uint32_t>(gaussians_.size()));
    gaussians_.append_row(seeded, row);
  }
  return change;
}

}  // namespace edgesplat::optimise
