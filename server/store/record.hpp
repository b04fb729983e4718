// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace edgesplat::store {

/// How files of this module frame what they hold. On the disk, little endian: marker u32, type u8, length
/// u32, CRC32C u32 of the payload, CRC32C u32 of these 13 bytes, payload. Damage costs the records it hits:
/// the next one is found by its marker.
inline constexpr std::uint32_t kRecordMarker = 0x21525345U;  ///< "ESR!"
inline constexpr std::size_t kRecordHeader_bytes = 17;
inline constexpr std::size_t kMaxRecord_bytes = std::size_t{64} << 20U;

[[nodiscard]] std::array<std::byte, kRecordHeader_bytes> record_header(std::uint8_t type,
                                                                       std::span<const std::byte> payload);

struct Record {
  std::uint8_t type = 0;
  std::span<const std::byte> payload;
  std::size_t end = 0;  ///< position behind it
  bool whole = false;   ///< the payload is as it was written
};

/// Walks over the records of a file in memory. Single-owner.
class RecordReader {
 public:
  RecordReader(std::span<const std::byte> bytes, std::size_t first) : bytes_(bytes), position_(first) {}

  /// The next whole record; nothing at the end. What is between it and the last one is counted as damaged.
  std::optional<Record> next();
  /// Bytes passed over because they are no whole record.
  [[nodiscard]] std::size_t damaged_bytes() const { return damaged_bytes_; }

 private:
  [[nodiscard]] std::optional<Record> record_at(std::size_t position) const;

  std::span<const std::byte> bytes_;
  std::size_t position_;
  std::size_t damaged_bytes_ = 0;
};

}  // namespace edgesplat::store
