// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <functional>

namespace edgesplat::gaussian {

/// A Gaussian's name for life, never reused: who made it (16 bits: a robot or server instance) and a 48-bit
/// counter.
class GaussianId {
 public:
  constexpr GaussianId() = default;
  constexpr GaussianId(std::uint16_t origin, std::uint64_t counter)
      : packed_((static_cast<std::uint64_t>(origin) << 48U) | (counter & kCounterMask)) {}
  static constexpr GaussianId from_packed(std::uint64_t packed) {
    GaussianId id;
    id.packed_ = packed;
    return id;
  }
  [[nodiscard]] constexpr std::uint16_t origin() const { return static_cast<std::uint16_t>(packed_ >> 48U); }
  [[nodiscard]] constexpr std::uint64_t counter() const { return packed_ & kCounterMask; }
  [[nodiscard]] constexpr std::uint64_t packed() const { return packed_; }
  constexpr auto operator<=>(const GaussianId&) const = default;

 private:
  static constexpr std::uint64_t kCounterMask = (std::uint64_t{1} << 48U) - 1;
  std::uint64_t packed_ = 0;
};

}  // namespace edgesplat::gaussian

template <>
struct std::hash<edgesplat::gaussian::GaussianId> {
  std::size_t operator()(const edgesplat::gaussian::GaussianId& id) const noexcept {
    return std::hash<std::uint64_t>{}(id.packed());
  }
};
