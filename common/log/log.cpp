// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/log/log.hpp"

#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <array>
#include <charconv>
#include <memory>

namespace edgesplat::log {
namespace {

spdlog::level::level_enum to_spdlog(Level level) {
  switch (level) {
    case Level::kTrace:
      return spdlog::level::trace;
    case Level::kDebug:
      return spdlog::level::debug;
    case Level::kInfo:
      return spdlog::level::info;
    case Level::kWarn:
      return spdlog::level::warn;
    case Level::kError:
      return spdlog::level::err;
    case Level::kOff:
      break;
  }
  return spdlog::level::off;
}

/// The one place in the program that stands for stderr; made on first use.
spdlog::logger& stderr_logger() {
  static const std::unique_ptr<spdlog::logger> kLogger = [] {
    auto made =
        std::make_unique<spdlog::logger>("edgesplat", std::make_shared<spdlog::sinks::stderr_sink_mt>());
    made->set_pattern("%Y-%m-%dT%H:%M:%S.%e %L %v");
    made->set_level(spdlog::level::info);
    made->flush_on(spdlog::level::trace);
    return made;
  }();
  return *kLogger;
}

bool needs_quotes(std::string_view text) {
  if (text.empty()) return true;
  for (const char c : text)
    if (static_cast<unsigned char>(c) <= ' ' || c == '"' || c == '=' || c == '\\' || c == '\x7f') return true;
  return false;
}

void append_text(std::string& line, std::string_view text) {
  if (!needs_quotes(text)) {
    line += text;
    return;
  }
  constexpr std::string_view kHex = "0123456789abcdef";
  line += '"';
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      line += '\\';
      line += c;
    } else if (c == '\n') {
      line += "\\n";
    } else if (byte < ' ' || byte == 0x7f) {
      line += "\\x";
      line += kHex[byte >> 4U];
      line += kHex[byte & 15U];
    } else {
      line += c;
    }
  }
  line += '"';
}

template <typename T>
void append_number(std::string& line, T value) {
  std::array<char, 40> buffer{};
  std::to_chars_result end{};
  if constexpr (std::is_floating_point_v<T>) {
    end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value, std::chars_format::general, 6);
  } else {
    end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  }
  line.append(buffer.data(), end.ptr);
}

}  // namespace

void Value::append_to(std::string& line) const {
  std::visit(
      [&line](const auto& value) {
        using T = std::decay_t<decltype(value)>;
        if constexpr (std::is_same_v<T, bool>) {
          line += value ? "true" : "false";
        } else if constexpr (std::is_same_v<T, std::string_view>) {
          append_text(line, value);
        } else {
          append_number(line, value);
        }
      },
      value_);
}

void set_level(Level level) {
  stderr_logger().set_level(to_spdlog(level));
}

bool enabled(Level level) {
  return level != Level::kOff && stderr_logger().should_log(to_spdlog(level));
}

Result<Level> parse_level(std::string_view name) {
  constexpr std::array<std::string_view, 6> kNames{"trace", "debug", "info", "warn", "error", "off"};
  for (std::size_t i = 0; i < kNames.size(); ++i)
    if (kNames[i] == name) return static_cast<Level>(i);
  return fail(Errc::kInvalidConfig,
              "unknown log level \"" + std::string(name) + "\": use trace, debug, info, warn, error or off");
}

std::string format_line(std::string_view module, std::string_view event, std::span<const Field> fields) {
  std::string line;
  line.reserve(64 + 24 * fields.size());
  line.append(module).append(": ").append(event);
  for (const Field& field : fields) {
    line.append(" ").append(field.key).append("=");
    field.value.append_to(line);
  }
  return line;
}

void write(Level level, std::string_view module, std::string_view event, std::span<const Field> fields) {
  if (!enabled(level)) return;
  stderr_logger().log(to_spdlog(level), format_line(module, event, fields));
}

}  // namespace edgesplat::log
