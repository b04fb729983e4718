// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <new>
#include <vector>

namespace edgesplat {

/// Memory that begins with a line of cache.
template <typename T>
struct LineAllocator {
  static constexpr std::align_val_t kLine{64};
  using value_type = T;

  LineAllocator() = default;
  template <typename U>
  LineAllocator(const LineAllocator<U>& /*other*/) {}

  [[nodiscard]] T* allocate(std::size_t count) {
    return static_cast<T*>(::operator new(count * sizeof(T), kLine));
  }
  void deallocate(T* memory, std::size_t count) { ::operator delete(memory, count * sizeof(T), kLine); }

  bool operator==(const LineAllocator& /*other*/) const { return true; }
};

/// For what vectors of a line's length (AVX-512) are stored to, megabytes of it: a store that touches two
/// lines which are not in the cache takes ten times as long as one that touches one, and malloc's megabytes
/// begin 16 bytes into a page, so that every such store would touch two.
template <typename T>
using LineVector = std::vector<T, LineAllocator<T>>;

}  // namespace edgesplat
