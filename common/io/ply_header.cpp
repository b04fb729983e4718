// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/io/ply_table.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <utility>

namespace edgesplat::io::ply {
namespace {

struct TypeName {
  std::string_view name;
  Type type;
};
constexpr std::array kTypeNames = {
    TypeName{"char", Type::kInt8},      TypeName{"int8", Type::kInt8},
    TypeName{"uchar", Type::kUint8},    TypeName{"uint8", Type::kUint8},
    TypeName{"short", Type::kInt16},    TypeName{"int16", Type::kInt16},
    TypeName{"ushort", Type::kUint16},  TypeName{"uint16", Type::kUint16},
    TypeName{"int", Type::kInt32},      TypeName{"int32", Type::kInt32},
    TypeName{"uint", Type::kUint32},    TypeName{"uint32", Type::kUint32},
    TypeName{"float", Type::kFloat32},  TypeName{"float32", Type::kFloat32},
    TypeName{"double", Type::kFloat64}, TypeName{"float64", Type::kFloat64},
};

constexpr std::size_t kMaxHeaderBytes = std::size_t{1} << 16U;
constexpr std::size_t kMaxProperties = 1024;
constexpr std::size_t kMaxElements = 64;

tl::unexpected<Error> bad_header(const std::string& why) {
  return fail(Errc::kCorrupt, "PLY header: " + why);
}

std::vector<std::string_view> split_words(std::string_view line) {
  std::vector<std::string_view> words;
  while (!line.empty()) {
    const std::size_t end = std::min(line.find_first_of(" \t"), line.size());
    if (end > 0) words.push_back(line.substr(0, end));
    line.remove_prefix(std::min(end + 1, line.size()));
  }
  return words;
}

/// Reads header lines one after the other and fills tables.
class HeaderParser {
 public:
  Status parse_line(std::string_view line);
  Result<File> finish(std::span<const std::byte> body);

 private:
  Status parse_format(std::span<const std::string_view> words);
  Status parse_element(std::span<const std::string_view> words);
  Status parse_property(std::span<const std::string_view> words);

  Table format_;  ///< what the file's format says of each table
  std::vector<Table> tables_;
  bool has_format_ = false;
};

Status HeaderParser::parse_format(std::span<const std::string_view> words) {
  if (words.size() != 3 || words[2] != "1.0") return bad_header("expected 'format <name> 1.0'");
  if (words[1] != "ascii" && words[1] != "binary_little_endian" && words[1] != "binary_big_endian") {
    return bad_header("unknown format");
  }
  if (!tables_.empty()) return bad_header("the format must come before the elements");
  format_.is_ascii = words[1] == "ascii";
  format_.is_big_endian = words[1] == "binary_big_endian";
  has_format_ = true;
  return {};
}

Status HeaderParser::parse_element(std::span<const std::string_view> words) {
  std::uint64_t count = 0;
  if (words.size() != 3) return bad_header("expected 'element <name> <count>'");
  const auto* const end = words[2].data() + words[2].size();
  const auto parsed = std::from_chars(words[2].data(), end, count);
  if (parsed.ec != std::errc{} || parsed.ptr != end) return bad_header("an element count is not a number");
  const bool known = std::ranges::find(tables_, words[1], &Table::name) != tables_.end();
  if (known) return bad_header("element " + std::string(words[1].substr(0, 40)) + " is stated twice");
  if (tables_.size() == kMaxElements) return bad_header("too many elements");
  tables_.push_back(format_);
  tables_.back().name = words[1];
  tables_.back().row_count = static_cast<std::size_t>(count);
  return {};
}

Status HeaderParser::parse_property(std::span<const std::string_view> words) {
  if (tables_.empty()) return bad_header("a property without an element");
  Table& table = tables_.back();
  if (words.size() == 5 && words[1] == "list") {
    table.has_lists = true;
    return {};
  }
  if (words.size() != 3) return bad_header("a malformed property");
  const auto known = std::ranges::find(kTypeNames, words[1], &TypeName::name);
  if (known == kTypeNames.end())
    return bad_header("unknown type '" + std::string(words[1].substr(0, 40)) + "'");
  if (table.properties.size() == kMaxProperties) return bad_header("too many properties");
  table.properties.push_back({std::string(words[2]), known->type, table.row_bytes});
  table.row_bytes += size_bytes(known->type);
  return {};
}

Status HeaderParser::parse_line(std::string_view line) {
  const auto words = split_words(line);
  if (words.empty() || words[0] == "comment" || words[0] == "obj_info") return {};
  if (words[0] == "format") return parse_format(words);
  if (words[0] == "element") return parse_element(words);
  if (words[0] == "property") return parse_property(words);
  return bad_header("unknown line '" + std::string(line.substr(0, 40)) + "'");
}

Result<File> HeaderParser::finish(std::span<const std::byte> body) {
  if (!has_format_) return bad_header("no format");
  return File{std::move(tables_), body};
}

/// Whether the table's rows fit into `bytes`.
Status check_room(const Table& table, std::size_t bytes) {
  if (table.row_count == 0) return {};
  if (table.has_lists) return bad_header("lists are not supported in element " + table.name);
  if (table.properties.empty()) return bad_header("element " + table.name + " has no properties");
  // A number of an ASCII row takes at least a digit and a blank (the very last one no blank).
  const std::size_t least_row_bytes = table.is_ascii ? 2 * table.properties.size() : table.row_bytes;
  const std::size_t room_bytes = bytes + (table.is_ascii ? 1 : 0);
  if (table.row_count <= room_bytes / least_row_bytes) return {};
  return fail(Errc::kCorrupt, "the PLY file is truncated: " + std::to_string(table.row_count) +
                                  " rows of element " + table.name + " do not fit into its " +
                                  std::to_string(bytes) + " bytes");
}

}  // namespace

std::size_t size_bytes(Type type) {
  switch (type) {
    case Type::kInt8:
    case Type::kUint8:
      return 1;
    case Type::kInt16:
    case Type::kUint16:
      return 2;
    case Type::kInt32:
    case Type::kUint32:
    case Type::kFloat32:
      return 4;
    case Type::kFloat64:
      break;
  }
  return 8;
}

std::optional<std::size_t> Table::find(std::string_view property) const {
  const auto found = std::ranges::find(properties, property, &Property::name);
  if (found == properties.end()) return std::nullopt;
  return static_cast<std::size_t>(found - properties.begin());
}

bool File::has(std::string_view element) const {
  return std::ranges::find(tables, element, &Table::name) != tables.end();
}

Result<File> open_file(std::span<const std::byte> bytes) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()),
                              std::min(bytes.size(), kMaxHeaderBytes));
  if (!text.starts_with("ply\n") && !text.starts_with("ply\r\n"))
    return fail(Errc::kCorrupt, "not a PLY file");
  HeaderParser parser;
  std::size_t position = text.find('\n') + 1;
  while (position < text.size()) {
    const std::size_t end = text.find('\n', position);
    if (end == std::string_view::npos) break;
    std::string_view line = text.substr(position, end - position);
    if (line.ends_with('\r')) line.remove_suffix(1);
    position = end + 1;
    if (line == "end_header") return parser.finish(bytes.subspan(position));
    EDGESPLAT_TRY_STATUS(parser.parse_line(line));
  }
  return bad_header("it has no end");
}

Result<Table> find_table(const File& file, std::string_view element) {
  std::span<const std::byte> rest = file.body;
  for (const Table& table : file.tables) {
    EDGESPLAT_TRY_STATUS(check_room(table, rest.size()));
    const std::size_t bytes = table.row_count * table.row_bytes;
    if (table.name == element) {
      Table found = table;
      found.rows = table.is_ascii ? rest : rest.first(bytes);
      return found;
    }
    if (table.is_ascii && table.row_count > 0) {
      return bad_header("in ASCII, element " + std::string(element) + " must come first");
    }
    rest = rest.subspan(bytes);
  }
  return bad_header("no element " + std::string(element));
}

Result<Table> open_vertices(std::span<const std::byte> bytes) {
  EDGESPLAT_TRY(const File file, open_file(bytes));
  return find_table(file, "vertex");
}

}  // namespace edgesplat::io::ply
