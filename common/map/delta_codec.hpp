// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/map/delta_header.hpp"
#include "common/map/row_codec.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace edgesplat::map {

inline constexpr std::size_t kMaxPoseCorrections = 16384;
inline constexpr std::size_t kMaxMaskSide_px = 256;
inline constexpr std::size_t kMaxMappedKeyframes = 16384;

/// Any delta as bytes: quantised fields, one zstd stream each, over the same header. The shortest rows are
/// sorted (sorted_by_chunk() for whole Gaussians, by id for the rest). Poses are rounded to float. Errors:
/// kInvalidArgument for arrays that disagree, counts over the limits or values that are not finite.
[[nodiscard]] Result<std::vector<std::byte>> encode_delta(const Delta& delta);

/// Checks everything decode_delta_header checks and every count before it allocates; what comes back can be
/// applied as it is. kCorrupt otherwise. Allocates at most some 10 MB beyond twice the input.
[[nodiscard]] Result<Delta> decode_delta(std::span<const std::byte> bytes);

/// The rows of an ADD or CHUNK_REPLACE alone, as map files keep them.
void write_whole_rows(AttributeWriter& out, const QuantisedRows& rows);
[[nodiscard]] Result<QuantisedRows> read_whole_rows(ByteReader& in, int sh_degree, std::size_t count);

}  // namespace edgesplat::map
