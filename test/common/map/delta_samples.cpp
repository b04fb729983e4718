// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "test/common/map/delta_samples.hpp"

#include "common/map/row_codec.hpp"
#include "test/support/map_samples.hpp"
#include "test/support/random.hpp"

namespace edgesplat::test {

map::DeltaHeader sample_header() {
  map::DeltaHeader header;
  header.robot.value = 12;
  for (std::size_t i = 0; i < 16; ++i) header.map.bytes[i] = static_cast<std::byte>(i);
  header.epoch.value = 3;
  header.seq = 1000;
  header.base_seq = 999;
  return header;
}

std::vector<map::Delta> all_kinds(std::size_t count) {
  Random random(9);
  const auto rows = random_rows(count, 4, 1);
  const auto others = random_rows(count, 5, 1);
  map::UpdateBody update;
  update.fields = map::kAllFields;
  update.differences.sh_degree = 1;
  for (std::size_t row = 0; row < count; ++row)
    map::append_difference(rows, row, others, row, update.differences);
  map::ChunkReplaceBody replace;
  replace.chunk = {-3, 2, 1};
  replace.level = 2;
  replace.more = true;
  replace.rows = rows;
  replace.rows.chunks.assign(count, replace.chunk);
  map::ReposeBody repose;
  for (std::uint32_t keyframe = 0; keyframe < 5; ++keyframe)
    repose.corrections.push_back({keyframe, 2, random.transform(), random.transform()});
  map::MaskBody mask{7, 3, 40, 30, std::vector<std::uint8_t>(1200)};
  for (auto& pixel : mask.dynamic) pixel = static_cast<std::uint8_t>(random.below(256));
  const map::DeltaHeader header = sample_header();
  return {{header, map::AddBody{rows}},
          {header, update},
          {header, map::RemoveBody{rows.ids}},
          {header, replace},
          {header, repose},
          {header, mask},
          {header, map::MappedBody{{0, 3, 4, 70000, 0xFFFFFFFFU}}}};
}

bool same_rows(const map::QuantisedRows& a, const map::QuantisedRows& b) {
  return a.sh_degree == b.sh_degree && a.ids == b.ids && a.chunks == b.chunks && a.channels == b.channels &&
         a.sh_rest == b.sh_rest && a.anchors == b.anchors;
}

}  // namespace edgesplat::test
