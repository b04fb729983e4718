// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <variant>

namespace edgesplat::log {

enum class Level : std::uint8_t { kTrace, kDebug, kInfo, kWarn, kError, kOff };

/// What a key can hold. Text is borrowed until the line is written.
class Value {
 public:
  Value(bool value) : value_(value) {}  // NOLINT(google-explicit-constructor): `"lost", n` is the point
  template <typename T>
  requires std::signed_integral<T> Value(T value)
      : value_(static_cast<std::int64_t>(value)) {}  // NOLINT(google-explicit-constructor)
  template <typename T>
  requires(std::unsigned_integral<T> && !std::same_as<T, bool>) Value(T value)
      : value_(static_cast<std::uint64_t>(value)) {}  // NOLINT(google-explicit-constructor)
  template <typename T>
  requires std::floating_point<T> Value(T value)
      : value_(static_cast<double>(value)) {}  // NOLINT(google-explicit-constructor)
  template <typename T>
  requires std::convertible_to<const T&, std::string_view> Value(const T& value)
      : value_(std::string_view(value)) {}  // NOLINT(google-explicit-constructor)

  /// Appends the value as it stands in the line: text with spaces, quotes or control characters is quoted.
  void append_to(std::string& line) const;

 private:
  std::variant<bool, std::int64_t, std::uint64_t, double, std::string_view> value_;
};

struct Field {
  std::string_view key;
  Value value;
};

/// Lines below this level are not built. Process-wide, as stderr is; default kInfo. Thread-safe.
void set_level(Level level);
[[nodiscard]] bool enabled(Level level);
/// "trace", "debug", "info", "warn", "error", "off"; kInvalidConfig for anything else.
[[nodiscard]] Result<Level> parse_level(std::string_view name);

/// `livox: packet gap lost=3 source="192.168.1.3:56301"`: the line without time and level.
[[nodiscard]] std::string format_line(std::string_view module, std::string_view event,
                                      std::span<const Field> fields);
/// Writes one line with time and level to stderr. Thread-safe; use the macros.
void write(Level level, std::string_view module, std::string_view event, std::span<const Field> fields);

/// Takes key, value, key, value, ... as the macros pass them.
template <typename... KeyValues>
void write_pairs(Level level, std::string_view module, std::string_view event,
                 const KeyValues&... key_values) {
  static_assert(sizeof...(KeyValues) % 2 == 0, "fields come as key, value pairs");
  if constexpr (sizeof...(KeyValues) == 0) {
    write(level, module, event, {});
  } else {
    const auto all = std::forward_as_tuple(key_values...);
    [&]<std::size_t... I>(std::index_sequence<I...>) {
      const Field fields[] = {Field{std::get<2 * I>(all), Value(std::get<2 * I + 1>(all))}...};
      write(level, module, event, fields);
    }
    (std::make_index_sequence<sizeof...(KeyValues) / 2>{});
  }
}

}  // namespace edgesplat::log

/// `EDGESPLAT_LOG_WARN("livox", "packet gap", "lost", n);` The values are evaluated only if the line is
/// wanted.
#define EDGESPLAT_LOG(level, ...)                                                            \
  do {                                                                                       \
    if (::edgesplat::log::enabled(level)) ::edgesplat::log::write_pairs(level, __VA_ARGS__); \
  } while (false)
#define EDGESPLAT_LOG_TRACE(...) EDGESPLAT_LOG(::edgesplat::log::Level::kTrace, __VA_ARGS__)
#define EDGESPLAT_LOG_DEBUG(...) EDGESPLAT_LOG(::edgesplat::log::Level::kDebug, __VA_ARGS__)
#define EDGESPLAT_LOG_INFO(...) EDGESPLAT_LOG(::edgesplat::log::Level::kInfo, __VA_ARGS__)
#define EDGESPLAT_LOG_WARN(...) EDGESPLAT_LOG(::edgesplat::log::Level::kWarn, __VA_ARGS__)
#define EDGESPLAT_LOG_ERROR(...) EDGESPLAT_LOG(::edgesplat::log::Level::kError, __VA_ARGS__)
