// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

namespace edgesplat {

/// A view of a row-major picture or table that somebody else owns. `stride` is in elements, >= width.
template <typename T>
class Span2d {
 public:
  Span2d() = default;
  Span2d(T* first, std::size_t width, std::size_t height, std::size_t stride)
      : first_(first), width_(width), height_(height), stride_(stride) {}
  Span2d(T* first, std::size_t width, std::size_t height) : Span2d(first, width, height, width) {}

  [[nodiscard]] std::size_t width() const { return width_; }
  [[nodiscard]] std::size_t height() const { return height_; }
  [[nodiscard]] std::size_t stride() const { return stride_; }
  [[nodiscard]] bool empty() const { return width_ == 0 || height_ == 0; }
  [[nodiscard]] std::span<T> row(std::size_t y) const { return {first_ + y * stride_, width_}; }
  [[nodiscard]] T& operator()(std::size_t x, std::size_t y) const { return first_[y * stride_ + x]; }

 private:
  T* first_ = nullptr;
  std::size_t width_ = 0;
  std::size_t height_ = 0;
  std::size_t stride_ = 0;
};

}  // namespace edgesplat
