// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"

#include <cstddef>
#include <string_view>

namespace edgesplat::core {

/// The GPU memory that one part of the program may use; builds with CUDA only. Everything on the device comes
/// from one, so that a map that grows too large is an error value and not the end of other programs on a
/// board whose memory CPU and GPU share. Taking and giving back wait for the device: buffers keep what they
/// have and grow in steps, so that a steady pipeline does neither. Single-owner; must outlive its buffers.
class VramPool {
 public:
  explicit VramPool(std::size_t budget_bytes) : budget_bytes_(budget_bytes) {}
  VramPool(const VramPool&) = delete;
  VramPool& operator=(const VramPool&) = delete;

  /// kOutOfVram where the budget or the device has no room, saying for what (`purpose`). 0 bytes: nullptr.
  [[nodiscard]] Result<void*> take(std::size_t bytes, std::string_view purpose);
  /// What take() gave for `bytes`.
  void give_back(void* first, std::size_t bytes);

  [[nodiscard]] std::size_t budget_bytes() const { return budget_bytes_; }
  [[nodiscard]] std::size_t used_bytes() const { return used_bytes_; }
  [[nodiscard]] std::size_t peak_bytes() const { return peak_bytes_; }

 private:
  std::size_t budget_bytes_;
  std::size_t used_bytes_ = 0;
  std::size_t peak_bytes_ = 0;
};

/// `share` of what is free on the device now. kUnavailable without a device.
[[nodiscard]] Result<std::size_t> share_of_free_vram(double share);

}  // namespace edgesplat::core
