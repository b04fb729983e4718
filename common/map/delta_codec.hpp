// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/map/delta.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace edgesplat::map {

inline constexpr std::uint32_t kDeltaMagic = 0x31445345U;  ///< "ESD1"
inline constexpr std::uint16_t kDeltaVersion = 1;
inline constexpr std::size_t kDeltaHeader_bytes = 57;
inline constexpr std::size_t kMaxDeltaRecords = 65536;
inline constexpr std::size_t kMaxDelta_bytes = std::size_t{20} << 20U;

/// Bytes of an ADD. `header.count` and `length_bytes` are filled in from the rows. Rows in runs of one chunk
/// are the shortest; means and scales travel as float32. Errors: kInvalidArgument for an inconsistent cloud,
/// more than kMaxDeltaRecords rows or a value that is not finite.
[[nodiscard]] Result<std::vector<std::byte>> encode_add(const AddDelta& delta);

/// Header of any delta after checking magic, version, kind, length and CRC32C: what is left is to understand
/// the body. kCorrupt with the reason otherwise.
[[nodiscard]] Result<DeltaHeader> decode_delta_header(std::span<const std::byte> bytes);

/// The whole of an ADD. Checks everything decode_delta_header checks, the counts before it allocates, that
/// every float is finite, means lie within kMapLimit_m and quaternions are of unit length within 1e-2.
/// kCorrupt otherwise, kInvalidArgument for another kind. Allocates at most about twice the input.
[[nodiscard]] Result<AddDelta> decode_add(std::span<const std::byte> bytes);

}  // namespace edgesplat::map
