// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <cstddef>
#include <functional>

namespace edgesplat {

/// An integer that cannot be mistaken for another kind of id: `using KeyframeId = StrongId<struct
/// KeyframeTag, uint32_t>;`
template <typename Tag, typename Rep>
struct StrongId {
  Rep value{};
  constexpr auto operator<=>(const StrongId&) const = default;
};

}  // namespace edgesplat

template <typename Tag, typename Rep>
struct std::hash<edgesplat::StrongId<Tag, Rep>> {
  std::size_t operator()(const edgesplat::StrongId<Tag, Rep>& id) const noexcept {
    return std::hash<Rep>{}(id.value);
  }
};
