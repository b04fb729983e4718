// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/bytes.hpp"
#include "common/base/result.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace edgesplat::map {

/// What the integers of an array mean; decides which forms are tried.
enum class Values : std::uint8_t { kAbsolute, kDifferences };

/// Writes arrays one by one, each in the shortest of a few forms: as it is or as differences from one row
/// to the next, raw or zstd. Single-owner.
class AttributeWriter {
 public:
  /// `out` must outlive this.
  explicit AttributeWriter(ByteWriter& out);
  ~AttributeWriter();
  AttributeWriter(const AttributeWriter&) = delete;
  AttributeWriter& operator=(const AttributeWriter&) = delete;

  /// Bytes whose number the reader knows.
  void bytes(std::span<const std::byte> raw);
  /// Bytes whose number is written before them.
  void sized_bytes(std::span<const std::byte> raw);
  /// `columns` arrays of equal length behind each other, of integers below 2^bits; 1 to 16 bits.
  void integers(std::span<const std::uint16_t> values, std::size_t columns, unsigned bits, Values kind);

 private:
  void planes(std::span<const std::uint16_t> values, unsigned bits, ByteWriter& out);
  void block(std::span<const std::byte> raw, ByteWriter& out);

  struct Context;
  ByteWriter& out_;
  std::unique_ptr<Context> context_;
};

/// The counterparts, for bytes from outside: nothing is allocated but the array asked for, whose size the
/// caller bounds. Errors: kCorrupt.
class AttributeReader {
 public:
  explicit AttributeReader(ByteReader& in) : in_(in) {}

  [[nodiscard]] Result<std::vector<std::byte>> bytes(std::size_t count);
  /// kCorrupt too where there are more than `max_count`.
  [[nodiscard]] Result<std::vector<std::byte>> sized_bytes(std::size_t max_count);
  [[nodiscard]] Result<std::vector<std::uint16_t>> integers(std::size_t rows, std::size_t columns,
                                                            unsigned bits);

 private:
  ByteReader& in_;
};

}  // namespace edgesplat::map
