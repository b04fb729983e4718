// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/config/config_file.hpp"
#include "common/config/number_text.hpp"

namespace edgesplat::config {
namespace {

std::string escaped(std::string_view text) {
  constexpr std::string_view kHex = "0123456789abcdef";
  std::string out = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (byte < ' ' || byte == 0x7f) {
      out += "\\u00";
      out += kHex[byte >> 4U];
      out += kHex[byte & 15U];
    } else {
      out += c;
    }
  }
  return out + '"';
}

std::string list_text(std::span<const double> values) {
  std::string out = "[";
  for (std::size_t i = 0; i < values.size(); ++i)
    out.append(i == 0 ? "" : ", ").append(number_text(values[i]));
  return out + "]";
}

std::string range_text(Range<double> range) {
  return "[" + number_text(range.min) + ", " + number_text(range.max) + "]";
}

/// Writes what it visits. TOML wants a table's own keys before its nested tables, so each table is collected.
class ConfigPrinter final : public ConfigReader {
 public:
  ConfigPrinter() { sections_.emplace_back(); }
  [[nodiscard]] std::string text() const { return sections_.front().keys + sections_.front().tables; }
  void problem(std::string_view /*key*/, std::string_view /*sentence*/) override {}

 protected:
  void visit_bool(std::string_view key, bool& value, std::string_view doc) override {
    add(key, value ? "true" : "false", doc, "");
  }
  void visit_text(std::string_view key, std::string& value, std::string_view doc) override {
    add(key, escaped(value), doc, "");
  }
  void visit_integer(std::string_view key, std::int64_t& value, Range<std::int64_t> range,
                     std::string_view doc) override {
    add(key, std::to_string(value), doc,
        "[" + std::to_string(range.min) + ", " + std::to_string(range.max) + "]");
  }
  void visit_numbers(std::string_view key, std::span<double> values, Range<double> range,
                     std::string_view doc, Shape shape) override {
    add(key, shape == Shape::kScalar ? number_text(values.front()) : list_text(values), doc,
        range_text(range));
  }
  void visit_list(std::string_view key, std::vector<double>& values, Range<double> range,
                  std::string_view doc, Range<std::size_t> /*length*/) override {
    add(key, list_text(values), doc, range_text(range));
  }
  void visit_choice(std::string_view key, std::size_t& index, std::span<const std::string_view> allowed,
                    std::string_view doc) override {
    std::string names;
    for (const std::string_view name : allowed) names.append(names.empty() ? "" : " | ").append(name);
    add(key, escaped(allowed[index]), doc, names);
  }
  bool begin_table(std::string_view key, std::string_view doc, bool has_value) override {
    if (!has_value) return false;
    const std::string& outer = sections_.back().path;
    Section section;
    section.path = outer.empty() ? std::string(key) : outer + "." + std::string(key);
    section.doc = doc;
    sections_.push_back(std::move(section));
    return true;
  }
  void end_table() override {
    const Section done = std::move(sections_.back());
    sections_.pop_back();
    std::string& out = sections_.back().tables;
    out += "\n";
    if (!done.doc.empty()) out += "# " + done.doc + "\n";
    out += (done.is_one_of_several ? "[[" + done.path + "]]\n" : "[" + done.path + "]\n") + done.keys +
           done.tables;
  }
  std::size_t count_tables(std::string_view /*key*/, std::size_t present, std::size_t /*most*/) override {
    return present;
  }
  void begin_table_of(std::string_view key, std::string_view doc, std::size_t /*index*/,
                      std::size_t count) override {
    (void)begin_table(key, doc, true);
    sections_.back().is_one_of_several = count > 1;
  }

 private:
  struct Section {
    std::string path;
    std::string doc;
    std::string keys;
    std::string tables;
    bool is_one_of_several = false;
  };
  void add(std::string_view key, const std::string& value, std::string_view doc, const std::string& allowed) {
    std::string& out = sections_.back().keys;
    if (!doc.empty() || !allowed.empty()) out += "#";
    if (!doc.empty()) out.append(" ").append(doc);
    if (!allowed.empty()) out.append(doc.empty() ? " " : ", ").append(allowed);
    if (!doc.empty() || !allowed.empty()) out += "\n";
    out.append(key).append(" = ").append(value).append("\n");
  }

  std::vector<Section> sections_;
};

}  // namespace

std::string print_toml(const std::function<void(ConfigReader&)>& describe_all) {
  ConfigPrinter printer;
  describe_all(printer);
  return printer.text();
}

}  // namespace edgesplat::config
