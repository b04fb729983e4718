// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <optional>
#include <span>
#include <string_view>
#include <system_error>
#include <type_traits>

/// Lines and words of COLMAP's text files. Inside common/io only.
namespace edgesplat::io::colmap {

/// Reads words of one line. As with ByteReader, what is not there gives zero and makes ok() false for good.
class WordReader {
 public:
  explicit WordReader(std::string_view line) : rest_(line) { skip_blanks(); }

  std::string_view word() {
    const std::size_t length = std::min(rest_.find_first_of(kBlank), rest_.size());
    const std::string_view word = rest_.substr(0, length);
    ok_ = ok_ && length > 0;
    rest_.remove_prefix(length);
    skip_blanks();
    return word;
  }
  template <typename T>
  requires std::is_arithmetic_v<T> T read() {
    const std::string_view text = word();
    T value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    ok_ = ok_ && error == std::errc{} && end == text.data() + text.size();
    return ok_ ? value : T{};
  }
  /// What is left of the line, without blanks at its ends: names may have some within.
  [[nodiscard]] std::string_view rest() const { return rest_; }
  [[nodiscard]] bool ok() const { return ok_; }

 private:
  static constexpr std::string_view kBlank = " \t\r";
  void skip_blanks() {
    rest_.remove_prefix(std::min(rest_.find_first_not_of(kBlank), rest_.size()));
    if (!rest_.empty()) rest_ = rest_.substr(0, rest_.find_last_not_of(kBlank) + 1);
  }
  std::string_view rest_;
  bool ok_ = true;
};

/// Goes through a text line by line.
class LineReader {
 public:
  explicit LineReader(std::string_view text) : rest_(text) {}

  /// The next line, whatever is in it; nothing at the end.
  std::optional<std::string_view> any() {
    if (rest_.empty()) return std::nullopt;
    const std::size_t end = std::min(rest_.find('\n'), rest_.size());
    const std::string_view line = rest_.substr(0, end);
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    ++number_;
    return line;
  }
  /// The next one that is neither blank nor a comment.
  std::optional<std::string_view> next() {
    while (const auto line = any()) {
      const std::string_view words = WordReader(*line).rest();
      if (!words.empty() && words.front() != '#') return words;
    }
    return std::nullopt;
  }
  [[nodiscard]] std::size_t number() const { return number_; }

 private:
  std::string_view rest_;
  std::size_t number_ = 0;
};

inline std::string_view as_text(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace edgesplat::io::colmap
