// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/io/ply_table.hpp"

#include <charconv>
#include <cstring>
#include <limits>

namespace edgesplat::io::ply {
namespace {

template <typename T>
float load(const std::byte* from) {
  T value{};
  std::memcpy(&value, from, sizeof(T));
  return static_cast<float>(value);
}

float load(Type type, const std::byte* from) {
  switch (type) {
    case Type::kInt8:
      return load<std::int8_t>(from);
    case Type::kUint8:
      return load<std::uint8_t>(from);
    case Type::kInt16:
      return load<std::int16_t>(from);
    case Type::kUint16:
      return load<std::uint16_t>(from);
    case Type::kInt32:
      return load<std::int32_t>(from);
    case Type::kUint32:
      return load<std::uint32_t>(from);
    case Type::kFloat32:
      return load<float>(from);
    case Type::kFloat64:
      break;
  }
  return load<double>(from);
}

std::vector<float> read_binary(const Table& table, std::span<const std::size_t> columns) {
  std::vector<float> values;
  values.reserve(table.row_count * columns.size());
  const std::byte* row = table.rows.data();
  for (std::size_t i = 0; i < table.row_count; ++i, row += table.row_bytes) {
    for (const std::size_t column : columns) {
      const Property& property = table.properties[column];
      values.push_back(load(property.type, row + property.offset));
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
        return fail(Errc::kCorrupt, "PLY vertex " + std::to_string(i) + " is not made of numbers");
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

}  // namespace edgesplat::io::ply
