// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"

#include <utility>

struct CUstream_st;

namespace edgesplat::core {

/// A queue of work on the GPU (cudaStream_t) of its own; builds with CUDA only. Operations take one, put
/// their work into it and do not wait for it. Single-owner.
class Stream {
 public:
  /// kUnavailable without a device or driver.
  static Result<Stream> create();
  Stream(Stream&& other) noexcept : handle_(std::exchange(other.handle_, nullptr)) {}
  Stream& operator=(Stream&& other) noexcept {
    std::swap(handle_, other.handle_);
    return *this;
  }
  ~Stream();
  [[nodiscard]] CUstream_st* get() const { return handle_; }
  /// Waits until everything put in is done; errors of that work come out here.
  [[nodiscard]] Status synchronise() const;

 private:
  Stream() = default;
  CUstream_st* handle_ = nullptr;
};

}  // namespace edgesplat::core
