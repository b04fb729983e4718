// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/core/cuda_status.cuh"
#include "kernels/core/stream.hpp"
#include "kernels/core/vram_pool.hpp"

#include <cstddef>
#include <span>
#include <utility>

namespace edgesplat::core {

/// An array on the device that grows and never shrinks. Single-owner; the pool must outlive it.
template <typename T>
class DeviceBuffer {
 public:
  /// Empty. `purpose` is said where memory runs out.
  DeviceBuffer(VramPool& pool, const char* purpose) : pool_(&pool), purpose_(purpose) {}
  DeviceBuffer(const DeviceBuffer&) = delete;
  DeviceBuffer& operator=(const DeviceBuffer&) = delete;
  ~DeviceBuffer() { pool_->give_back(first_, capacity_ * sizeof(T)); }

  /// Room for `count` values; growing loses what was there and takes a quarter more, so that a growing map
  /// does not grow its buffers every time. kOutOfVram: then the buffer is empty.
  [[nodiscard]] Status reserve(std::size_t count) {
    if (count <= capacity_) return {};
    const std::size_t grown = capacity_ == 0 ? count : count + count / 4;
    pool_->give_back(std::exchange(first_, nullptr), std::exchange(capacity_, 0) * sizeof(T));
    EDGESPLAT_TRY(void* const first, pool_->take(grown * sizeof(T), purpose_));
    first_ = static_cast<T*>(first);
    capacity_ = grown;
    return {};
  }
  /// The same, keeping the first `kept` values. Waits. kOutOfVram: then the buffer is as it was.
  [[nodiscard]] Status grow(const Stream& stream, std::size_t count, std::size_t kept) {
    if (count <= capacity_) return {};
    const std::size_t grown = count + count / 4;
    EDGESPLAT_TRY(void* const first, pool_->take(grown * sizeof(T), purpose_));
    const Status copied = kept == 0 ? Status{}
                                    : cuda_status(cudaMemcpyAsync(first, first_, kept * sizeof(T),
                                                                  cudaMemcpyDeviceToDevice, stream.get()),
                                                  "copying on the device");
    const Status done = copied ? stream.synchronise() : copied;
    if (!done) {
      pool_->give_back(first, grown * sizeof(T));
      return done;
    }
    pool_->give_back(std::exchange(first_, static_cast<T*>(first)),
                     std::exchange(capacity_, grown) * sizeof(T));
    return {};
  }
  [[nodiscard]] T* data() { return first_; }
  [[nodiscard]] const T* data() const { return first_; }
  [[nodiscard]] std::size_t capacity() const { return capacity_; }

 private:
  VramPool* pool_;
  const char* purpose_;
  T* first_ = nullptr;
  std::size_t capacity_ = 0;
};

/// Puts a copy to the device into the stream, growing `to` first.
template <typename T>
[[nodiscard]] Status upload(const Stream& stream, std::span<const T> from, DeviceBuffer<T>& to) {
  EDGESPLAT_TRY_STATUS(to.reserve(from.size()));
  if (from.empty()) return {};
  EDGESPLAT_CUDA_TRY(
      cudaMemcpyAsync(to.data(), from.data(), from.size_bytes(), cudaMemcpyHostToDevice, stream.get()));
  return {};
}

/// Puts a copy of the first to.size() values to the host into the stream; they are there after
/// stream.synchronise().
template <typename T>
[[nodiscard]] Status download(const Stream& stream, const DeviceBuffer<T>& from, std::span<T> to) {
  if (to.empty()) return {};
  EDGESPLAT_CUDA_TRY(
      cudaMemcpyAsync(to.data(), from.data(), to.size_bytes(), cudaMemcpyDeviceToHost, stream.get()));
  return {};
}

/// Sets every byte of the first `count` values.
template <typename T>
[[nodiscard]] Status fill_bytes(const Stream& stream, DeviceBuffer<T>& buffer, int byte, std::size_t count) {
  if (count == 0) return {};
  EDGESPLAT_CUDA_TRY(cudaMemsetAsync(buffer.data(), byte, count * sizeof(T), stream.get()));
  return {};
}

}  // namespace edgesplat::core
