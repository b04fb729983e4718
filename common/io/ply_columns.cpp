// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/io/ply_table.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstring>
#include <limits>

namespace edgesplat::io::ply {
namespace {

template <typename T>
T load_as(const std::byte* from, bool is_big_endian) {
  std::array<std::byte, sizeof(T)> bytes;
  std::memcpy(bytes.data(), from, sizeof(T));
  if (is_big_endian) std::ranges::reverse(bytes);
  return std::bit_cast<T>(bytes);
}

float load(Type type, const std::byte* from, bool is_big_endian) {
  switch (type) {
    case Type::kInt8:
      return static_cast<float>(load_as<std::int8_t>(from, is_big_endian));
    case Type::kUint8:
      return static_cast<float>(load_as<std::uint8_t>(from, is_big_endian));
    case Type::kInt16:
      return static_cast<float>(load_as<std::int16_t>(from, is_big_endian));
    case Type::kUint16:
      return static_cast<float>(load_as<std::uint16_t>(from, is_big_endian));
    case Type::kInt32:
      return static_cast<float>(load_as<std::int32_t>(from, is_big_endian));
    case Type::kUint32:
      return static_cast<float>(load_as<std::uint32_t>(from, is_big_endian));
    case Type::kFloat32:
      return load_as<float>(from, is_big_endian);
    case Type::kFloat64:
      break;
  }
  return static_cast<float>(load_as<double>(from, is_big_endian));
}

std::vector<float> read_binary(const Table& table, std::span<const std::size_t> columns) {
  std::vector<float> values;
  values.reserve(table.row_count * columns.size());
  const std::byte* row = table.rows.data();
  for (std::size_t i = 0; i < table.row_count; ++i, row += table.row_bytes) {
    for (const std::size_t column : columns) {
      const Property& property = table.properties[column];
      values.push_back(load(property.type, row + property.offset, table.is_big_endian));
    }
  }
  return values;
}

/// The next number of a text; false where there is none.
bool next_number(std::string_view& text, double& number) {
  text.remove_prefix(std::min(text.find_first_not_of(" \t\r\n"), text.size()));
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{}) return false;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return text.empty() || std::string_view(" \t\r\n").find(text.front()) != std::string_view::npos;
}

Result<std::vector<float>> read_ascii(const Table& table, std::span<const std::size_t> columns) {
  std::string_view text(reinterpret_cast<const char*>(table.rows.data()), table.rows.size());
  std::vector<double> row(table.properties.size());
  std::vector<float> values;
  values.reserve(table.row_count * columns.size());
  for (std::size_t i = 0; i < table.row_count; ++i) {
    for (double& number : row) {
      if (!next_number(text, number)) {
        return fail(Errc::kCorrupt,
                    "PLY " + table.name + " " + std::to_string(i) + " is not made of numbers");
      }
    }
    for (const std::size_t column : columns) values.push_back(static_cast<float>(row[column]));
  }
  return values;
}

}  // namespace

Result<std::vector<float>> read_columns(const Table& table, std::span<const std::size_t> columns) {
  if (table.is_ascii) return read_ascii(table, columns);
  return read_binary(table, columns);
}

Result<std::vector<std::uint32_t>> read_words(const Table& table, std::span<const std::size_t> columns) {
  for (const std::size_t column : columns) {
    if (table.is_ascii || table.properties[column].type != Type::kUint32) {
      return fail(Errc::kCorrupt, "PLY: " + table.properties[column].name + " must be a binary uint");
    }
  }
  std::vector<std::uint32_t> words;
  words.reserve(table.row_count * columns.size());
  const std::byte* row = table.rows.data();
  for (std::size_t i = 0; i < table.row_count; ++i, row += table.row_bytes) {
    for (const std::size_t column : columns) {
      words.push_back(load_as<std::uint32_t>(row + table.properties[column].offset, table.is_big_endian));
    }
  }
  return words;
}

}  // namespace edgesplat::io::ply
