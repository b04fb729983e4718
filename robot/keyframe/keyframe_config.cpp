// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/keyframe/keyframe_config.hpp"

#include "common/config/config_reader.hpp"

#include <algorithm>
#include <functional>

namespace edgesplat::keyframe {

void describe(config::ConfigReader& reader, KeyframeConfig& c) {
  using config::Range;
  reader.field("translation_m", c.translation_m, Range{0.05, 10.0}, "a keyframe after this much motion ...");
  reader.field("rotation_rad", c.rotation_rad, Range{0.02, 3.1}, "... or this much rotation");
  reader.field("min_interval_s", c.min_interval_s, Range{0.0, 10.0}, "but never sooner than this");
  reader.field("window_s", c.window_s, Range{0.0, 10.0},
               "how long a point may wait for a picture that sees it");
  reader.field("window_points", c.window_points, {1000, 10'000'000},
               "most waiting points, oldest dropped first");
  reader.field("occlusion_cell_px", c.occlusion_cell_px, {1, 64},
               "cell of the occlusion test, wider than point gaps");
  reader.field("occlusion_absolute_m", c.occlusion_absolute_m, Range{0.0, 5.0},
               "a point this far behind is hidden");
  reader.field("occlusion_relative", c.occlusion_relative, Range{0.0, 1.0},
               "... plus this share of its distance");
  reader.field("max_colour_range_m", c.max_colour_range_m, Range{1.0, 500.0}, "farther points get no colour");
  reader.field("point_spacing_m", c.point_spacing_m, Range{0.0, 1.0},
               "grid that thins a keyframe's points, 0 = all");
  reader.field("jpeg_quality", c.jpeg_quality, {1, 100}, "of the keyframes' pictures");
  reader.field(
      "hold_out_from_s", c.hold_out_from_s, Range{0.0, 1e6},
      "begins of blocks of pictures that are kept from the map, to compare it with; none = all go in",
      Range<std::size_t>{0, 16});
  reader.field("hold_out_pictures", c.hold_out_pictures, {1, 32}, "pictures in a block");
  if (std::adjacent_find(c.hold_out_from_s.begin(), c.hold_out_from_s.end(), std::greater_equal<>()) !=
      c.hold_out_from_s.end()) {
    reader.problem("hold_out_from_s", "must ascend");
  }
}

}  // namespace edgesplat::keyframe
