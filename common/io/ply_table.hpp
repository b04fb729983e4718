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

/// The elements of a PLY file as columns. Inside common/io only.
namespace edgesplat::io::ply {

enum class Type : std::uint8_t { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat32, kFloat64 };
[[nodiscard]] std::size_t size_bytes(Type type);

struct Property {
  std::string name;
  Type type = Type::kFloat32;
  std::size_t offset = 0;  ///< in a binary row
};

/// One element of a file: its rows as bytes or text.
struct Table {
  std::string name;
  bool is_ascii = false;
  bool is_big_endian = false;
  bool has_lists = false;  ///< no columns then, and nothing after it can be found
  std::size_t row_count = 0;
  std::size_t row_bytes = 0;  ///< binary only
  std::vector<Property> properties;
  std::span<const std::byte> rows;  ///< all of them, once find_table() gave the table

  [[nodiscard]] std::optional<std::size_t> find(std::string_view property) const;
};

/// What a file's header says; `body` is what follows it.
struct File {
  std::vector<Table> tables;  ///< in the order of the file
  std::span<const std::byte> body;

  [[nodiscard]] bool has(std::string_view element) const;
};

/// Parses the header. kCorrupt with the reason where it is none.
[[nodiscard]] Result<File> open_file(std::span<const std::byte> bytes);
/// An element with its rows. kCorrupt with the reason: not there, lists in it or before it, more rows than
/// the file has bytes for, in ASCII anything before it.
[[nodiscard]] Result<Table> find_table(const File& file, std::string_view element);
/// Element "vertex" of a file.
[[nodiscard]] Result<Table> open_vertices(std::span<const std::byte> bytes);

/// Values of the columns, row by row: out[row * columns.size() + i]. kCorrupt for a bad number in ASCII.
[[nodiscard]] Result<std::vector<float>> read_columns(const Table& table,
                                                      std::span<const std::size_t> columns);
/// The same with every bit of columns of type uint; kCorrupt for other types and ASCII.
[[nodiscard]] Result<std::vector<std::uint32_t>> read_words(const Table& table,
                                                            std::span<const std::size_t> columns);

}  // namespace edgesplat::io::ply
