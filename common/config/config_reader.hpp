// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace edgesplat::config {

/// Closed interval of allowed values.
template <typename T>
struct Range {
  T min;
  T max;
};
template <typename T>
Range(T, T) -> Range<T>;

/// Visits every field of a module's config. Each module writes, next to its `struct XConfig`, one function
///   void describe(config::ConfigReader& reader, XConfig& config) {
///     reader.field("voxel_size_m", config.voxel_size_m, Range{0.05, 5.0}, "edge of a map voxel");
///     reader.table("imu", "noise of the IMU", [&] { describe(reader, config.imu); });
///   }
/// and the same function loads the config (ConfigFile::read_into), prints it (to_toml) and lists its docs.
/// The value before the call is the default.
class ConfigReader {
 public:
  virtual ~ConfigReader() = default;

  void field(std::string_view key, bool& value, std::string_view doc) { visit_bool(key, value, doc); }
  void field(std::string_view key, std::string& value, std::string_view doc) { visit_text(key, value, doc); }
  void field(std::string_view key, double& value, Range<double> range, std::string_view doc) {
    visit_numbers(key, std::span(&value, 1), range, doc, Shape::kScalar);
  }
  void field(std::string_view key, float& value, Range<double> range, std::string_view doc) {
    double wide = widened(value);
    visit_numbers(key, std::span(&wide, 1), range, doc, Shape::kScalar);
    value = static_cast<float>(wide);
  }
  /// Whole numbers of any width; the range must fit the field's type.
  template <typename T>
  requires(std::is_integral_v<T> && !std::is_same_v<T, bool>) void field(std::string_view key, T& value,
                                                                         Range<std::type_identity_t<T>> range,
                                                                         std::string_view doc) {
    auto wide = clamped<T>(value);
    visit_integer(key, wide, {clamped<T>(range.min), clamped<T>(range.max)}, doc);
    value = static_cast<T>(wide);
  }
  /// A list of numbers of any length in `length`.
  void field(std::string_view key, std::vector<double>& values, Range<double> range, std::string_view doc,
             Range<std::size_t> length = {0, 4096}) {
    visit_list(key, values, range, doc, length);
  }
  /// A list of exactly values.size() numbers (a vector, a quaternion, distortion coefficients).
  void fixed(std::string_view key, std::span<double> values, Range<double> range, std::string_view doc) {
    visit_numbers(key, values, range, doc, Shape::kList);
  }
  /// One of some names.
  template <typename E>
  void choice(std::string_view key, E& value, std::initializer_list<std::pair<std::string_view, E>> names,
              std::string_view doc) {
    std::vector<std::string_view> allowed;
    std::vector<E> meanings;
    std::size_t index = 0;
    for (const auto& [name, meaning] : names) {
      if (meaning == value) index = allowed.size();
      allowed.push_back(name);
      meanings.push_back(meaning);
    }
    visit_choice(key, index, allowed, doc);
    value = meanings[index];
  }
  /// A nested table; `describe_inside` visits its fields.
  template <typename F>
  void table(std::string_view key, std::string_view doc, const F& describe_inside) {
    if (!begin_table(key, doc, true)) return;
    describe_inside();
    end_table();
  }
  /// A table that may be absent: set when the file has it. `describe_inside(T&)` visits its fields.
  template <typename T, typename F>
  void optional_table(std::string_view key, std::optional<T>& value, std::string_view doc,
                      const F& describe_inside) {
    if (!begin_table(key, doc, value.has_value())) return;
    if (!value) value.emplace();
    describe_inside(*value);
    end_table();
  }
  /// One table or several: [key] or [[key]]. A file that has none leaves `values` as they are; else there
  /// are as many as the file names, and those beyond the present ones begin as `fresh(index)`. One is printed
  /// as [key], several as [[key]]. `describe_inside(T&)` visits the fields of each. Precondition: `values`
  /// has 1..most elements.
  template <typename T, typename Fresh, typename F>
  void tables(std::string_view key, std::vector<T>& values, std::size_t most, std::string_view doc,
              const Fresh& fresh, const F& describe_inside) {
    const std::size_t count = count_tables(key, values.size(), most);
    while (values.size() < count) values.push_back(fresh(values.size()));
    values.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
      begin_table_of(key, doc, i, count);
      describe_inside(values[i]);
      end_table();
    }
  }
  /// Reports a rule between fields that the ranges cannot say, at the place of `key` of the current table.
  virtual void problem(std::string_view key, std::string_view sentence) = 0;

 protected:
  enum class Shape : std::uint8_t { kScalar, kList };

  virtual void visit_bool(std::string_view key, bool& value, std::string_view doc) = 0;
  virtual void visit_text(std::string_view key, std::string& value, std::string_view doc) = 0;
  virtual void visit_integer(std::string_view key, std::int64_t& value, Range<std::int64_t> range,
                             std::string_view doc) = 0;
  virtual void visit_numbers(std::string_view key, std::span<double> values, Range<double> range,
                             std::string_view doc, Shape shape) = 0;
  virtual void visit_list(std::string_view key, std::vector<double>& values, Range<double> range,
                          std::string_view doc, Range<std::size_t> length) = 0;
  virtual void visit_choice(std::string_view key, std::size_t& index,
                            std::span<const std::string_view> allowed, std::string_view doc) = 0;
  /// True when the fields inside are to be visited; then end_table() follows.
  virtual bool begin_table(std::string_view key, std::string_view doc, bool has_value) = 0;
  virtual void end_table() = 0;
  /// How many tables there are to visit, 1..most; `present`: where the file does not say.
  virtual std::size_t count_tables(std::string_view key, std::size_t present, std::size_t most) = 0;
  /// The `index`-th of `count` tables; end_table() follows.
  virtual void begin_table_of(std::string_view key, std::string_view doc, std::size_t index,
                              std::size_t count) = 0;

 private:
  /// The shortest decimal that reads back as this float: 0.6F is 0.6, not 0.60000002384185791.
  static double widened(float value);
  /// TOML's integers are int64: a larger unsigned bound is cut to that.
  template <typename T>
  static std::int64_t clamped(T value) {
    if constexpr (std::is_unsigned_v<T> && sizeof(T) == sizeof(std::int64_t)) {
      constexpr auto kMost = static_cast<T>(std::numeric_limits<std::int64_t>::max());
      return static_cast<std::int64_t>(value < kMost ? value : kMost);
    } else {
      return static_cast<std::int64_t>(value);
    }
  }
};

}  // namespace edgesplat::config
