// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace edgesplat::io {

/// Writes plain CDR (XCDR1), little-endian, as ROS 2 does: 4 bytes 00 01 00 00, then fields aligned to their
/// size counted from after those 4 bytes. Single-owner.
class CdrWriter {
 public:
  explicit CdrWriter(std::size_t expected_bytes = 0);
  template <typename T>
  requires std::is_arithmetic_v<T>
  void write(T value) {
    align(sizeof(T));
    const std::size_t position = bytes_.size();
    bytes_.resize(position + sizeof(T));
    std::memcpy(bytes_.data() + position, &value, sizeof(T));
  }
  void write_string(std::string_view text);
  /// sequence<uint8>
  void write_byte_sequence(std::span<const std::byte> bytes);
  [[nodiscard]] std::vector<std::byte> take() { return std::move(bytes_); }

 private:
  void align(std::size_t size);
  std::vector<std::byte> bytes_;
};

/// Reads the same from bytes that came from outside. A read past the end gives zeros and makes ok() false for
/// good; so does another encapsulation than little-endian CDR. Views point into the input. Single-owner.
class CdrReader {
 public:
  explicit CdrReader(std::span<const std::byte> bytes);
  template <typename T>
  requires std::is_arithmetic_v<T> T read() {
    T value{};
    const auto field = take(sizeof(T), sizeof(T));
    if (ok_) std::memcpy(&value, field.data(), sizeof(T));
    return value;
  }
  [[nodiscard]] std::string read_string();
  [[nodiscard]] std::span<const std::byte> read_byte_sequence();
  [[nodiscard]] bool ok() const { return ok_; }

 private:
  std::span<const std::byte> take(std::size_t count, std::size_t alignment);
  std::span<const std::byte> bytes_;  ///< after the encapsulation header
  std::size_t position_ = 0;
  bool ok_ = true;
};

}  // namespace edgesplat::io
