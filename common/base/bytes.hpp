// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/check.hpp"

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace edgesplat {

static_assert(std::endian::native == std::endian::little, "x86-64 and aarch64 are little-endian");

/// Reads little-endian fields from bytes that came from outside. A read past the end returns zeros and makes
/// ok() false for good: parse the whole record, then check ok() once. Single-owner.
class ByteReader {
 public:
  explicit ByteReader(std::span<const std::byte> bytes) : bytes_(bytes) {}

  template <typename T>
  requires std::is_arithmetic_v<T> T read() {
    T value{};
    if (sizeof(T) > remaining()) {
      ok_ = false;
      position_ = bytes_.size();
      return value;
    }
    std::memcpy(&value, bytes_.data() + position_, sizeof(T));
    position_ += sizeof(T);
    return value;
  }
  /// The next `count` bytes, or an empty span and ok() == false.
  std::span<const std::byte> take(std::size_t count) {
    if (count > remaining()) {
      ok_ = false;
      position_ = bytes_.size();
      return {};
    }
    const auto part = bytes_.subspan(position_, count);
    position_ += count;
    return part;
  }
  void skip(std::size_t count) { (void)take(count); }
  [[nodiscard]] std::size_t position() const { return position_; }
  [[nodiscard]] std::size_t remaining() const { return bytes_.size() - position_; }
  [[nodiscard]] bool ok() const { return ok_; }

 private:
  std::span<const std::byte> bytes_;
  std::size_t position_ = 0;
  bool ok_ = true;
};

/// Appends little-endian fields to a buffer it owns. Single-owner.
class ByteWriter {
 public:
  template <typename T>
  requires std::is_arithmetic_v<T>
  void write(T value) { std::memcpy(grow(sizeof(T)), &value, sizeof(T)); }
  void write_bytes(std::span<const std::byte> bytes) {
    if (bytes.empty()) return;
    std::memcpy(grow(bytes.size()), bytes.data(), bytes.size());
  }
  void write_text(std::string_view text) {
    write_bytes(std::as_bytes(std::span<const char>(text.data(), text.size())));
  }
  /// Overwrites a field written earlier, e.g. a length or a checksum.
  template <typename T>
  requires std::is_arithmetic_v<T>
  void patch(std::size_t position, T value) {
    EDGESPLAT_CHECK(position <= bytes_.size() && sizeof(T) <= bytes_.size() - position, "patch in range");
    std::memcpy(bytes_.data() + position, &value, sizeof(T));
  }
  [[nodiscard]] std::size_t size() const { return bytes_.size(); }
  [[nodiscard]] std::span<const std::byte> bytes() const { return bytes_; }
  [[nodiscard]] std::vector<std::byte> take() { return std::move(bytes_); }
  void clear() { bytes_.clear(); }
  void reserve(std::size_t size) { bytes_.reserve(size); }

 private:
  /// Room for `count` more bytes. Not inlined: g++ 12 warns of overflows that cannot be where it is.
  [[gnu::noinline]] std::byte* grow(std::size_t count) {
    const std::size_t position = bytes_.size();
    bytes_.resize(position + count);
    return bytes_.data() + position;
  }

  std::vector<std::byte> bytes_;
};

}  // namespace edgesplat
