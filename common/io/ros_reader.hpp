// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/io/bag_source.hpp"

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>
#include <type_traits>

namespace edgesplat::io {

/// Reads the fields of a ROS message in the order of its definition, whichever way they were written, so that
/// each message type is described once. A read past the end gives zeros and makes ok() false for good; so
/// does CDR that is not little-endian. Views point into the input. Single-owner.
class RosReader {
 public:
  RosReader(RosEncoding encoding, std::span<const std::byte> payload) : encoding_(encoding), bytes_(payload) {
    if (encoding == RosEncoding::kRos1) return;
    constexpr std::size_t kEncapsulationBytes = 4;
    ok_ = payload.size() >= kEncapsulationBytes && payload[0] == std::byte{0} && payload[1] == std::byte{1};
    bytes_ = ok_ ? payload.subspan(kEncapsulationBytes) : std::span<const std::byte>();
  }

  [[nodiscard]] RosEncoding encoding() const { return encoding_; }
  template <typename T>
  requires std::is_arithmetic_v<T> T read() {
    T value{};
    const auto field = take(sizeof(T), sizeof(T));
    if (field.size() == sizeof(T)) std::memcpy(&value, field.data(), sizeof(T));
    return value;
  }
  /// A fixed-size array that is not needed.
  template <typename T>
  void skip(std::size_t count) {
    (void)take(count * sizeof(T), sizeof(T));
  }
  [[nodiscard]] std::string_view read_text() {
    auto text = take(read<std::uint32_t>(), 1);
    const bool closing_zero = encoding_ == RosEncoding::kCdr && !text.empty();
    if (closing_zero && text.back() != std::byte{0}) ok_ = false;
    if (closing_zero) text = text.first(text.size() - 1);
    return {reinterpret_cast<const char*>(text.data()), text.size()};
  }
  /// uint8[]
  [[nodiscard]] std::span<const std::byte> read_bytes() { return take(read<std::uint32_t>(), 1); }
  /// The length of a list whose elements take `least_bytes` each at least; 0 where they cannot fit.
  [[nodiscard]] std::uint32_t read_count(std::size_t least_bytes) {
    const auto count = read<std::uint32_t>();
    if (count > remaining() / least_bytes) ok_ = false;
    return ok_ ? count : 0;
  }
  [[nodiscard]] std::size_t remaining() const { return bytes_.size() - position_; }
  [[nodiscard]] bool ok() const { return ok_; }

 private:
  std::span<const std::byte> take(std::size_t count, std::size_t alignment) {
    const std::size_t start =
        encoding_ == RosEncoding::kRos1 ? position_ : (position_ + alignment - 1) / alignment * alignment;
    if (!ok_ || start > bytes_.size() || count > bytes_.size() - start) {
      ok_ = false;
      return {};
    }
    position_ = start + count;
    return bytes_.subspan(start, count);
  }

  RosEncoding encoding_;
  std::span<const std::byte> bytes_;
  std::size_t position_ = 0;
  bool ok_ = true;
};

}  // namespace edgesplat::io
