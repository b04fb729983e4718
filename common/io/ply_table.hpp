// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// The vertices of a PLY file as columns. Inside common/io only.
namespace edgesplat::io::ply {

enum class Type : std::uint8_t { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat32, kFloat64 };
[[nodiscard]] std::size_t size_bytes(Type type);

struct Property {
  std::string name;
  Type type = Type::kFloat32;
  std::size_t offset = 0;  ///< in a binary row
};

/// Element "vertex" of a file: its rows as bytes or text, checked to be all there.
struct Table {
  bool is_ascii = false;
  std::size_t row_count = 0;
  std::size_t row_bytes = 0;  ///< binary only
  std::vector<Property> properties;
  std::span<const std::byte> rows;

  [[nodiscard]] std::optional<std::size_t> find(std::string_view name) const;
};

/// Parses the header and finds the vertices. kCorrupt with the reason: no PLY, big-endian, lists or other
/// elements before the vertices, more rows than the file has bytes for.
[[nodiscard]] Result<Table> open_table(std::span<const std::byte> bytes);

/// Values of the named columns, row by row: out[row * columns.size() + i]. kCorrupt for a bad number in
/// ASCII.
[[nodiscard]] Result<std::vector<float>> read_columns(const Table& table,
                                                      std::span<const std::size_t> columns);

}  // namespace edgesplat::io::ply
