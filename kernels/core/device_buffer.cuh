// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/core/cuda_status.cuh"

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace edgesplat::core {

/// A CUDA stream of its own. Single-owner.
class Stream {
 public:
  static Result<Stream> create() {
    Stream stream;
    EDGESPLAT_CUDA_TRY(cudaStreamCreateWithFlags(&stream.handle_, cudaStreamNonBlocking));
    return stream;
  }
  Stream(Stream&& other) noexcept : handle_(std::exchange(other.handle_, nullptr)) {}
  Stream& operator=(Stream&& other) noexcept {
    std::swap(handle_, other.handle_);
    return *this;
  }
  ~Stream() {
    if (handle_ != nullptr) cudaStreamDestroy(handle_);
  }
  [[nodiscard]] cudaStream_t get() const { return handle_; }
  [[nodiscard]] Status synchronise() const {
    return cuda_status(cudaStreamSynchronize(handle_), "synchronise");
  }

 private:
  Stream() = default;
  cudaStream_t handle_ = nullptr;
};

/// An array on the device, allocated and freed in the order of a stream, which must outlive it. Single-owner.
template <typename T>
class DeviceBuffer {
 public:
  /// Errors: kOutOfVram.
  static Result<DeviceBuffer> create(const Stream& stream, std::size_t count) {
    DeviceBuffer buffer(stream.get(), count);
    if (count == 0) return buffer;
    void* first = nullptr;
    EDGESPLAT_CUDA_TRY(cudaMallocAsync(&first, count * sizeof(T), stream.get()));
    buffer.first_ = static_cast<T*>(first);
    return buffer;
  }
  static Result<DeviceBuffer> copy_of(const Stream& stream, std::span<const T> values) {
    EDGESPLAT_TRY(DeviceBuffer buffer, create(stream, values.size()));
    if (!values.empty()) {
      EDGESPLAT_CUDA_TRY(cudaMemcpyAsync(buffer.first_, values.data(), values.size_bytes(),
                                         cudaMemcpyHostToDevice, stream.get()));
    }
    return buffer;
  }
  DeviceBuffer(DeviceBuffer&& other) noexcept
      : stream_(other.stream_), first_(std::exchange(other.first_, nullptr)), count_(other.count_) {}
  DeviceBuffer& operator=(DeviceBuffer&&) = delete;
  ~DeviceBuffer() {
    if (first_ != nullptr) cudaFreeAsync(first_, stream_);
  }
  [[nodiscard]] T* data() { return first_; }
  [[nodiscard]] const T* data() const { return first_; }
  /// Starts the copy back; the values are there after stream.synchronise().
  [[nodiscard]] Result<std::vector<T>> start_download() const {
    std::vector<T> values(count_);
    if (count_ > 0) {
      EDGESPLAT_CUDA_TRY(
          cudaMemcpyAsync(values.data(), first_, count_ * sizeof(T), cudaMemcpyDeviceToHost, stream_));
    }
    return values;
  }

 private:
  DeviceBuffer(cudaStream_t stream, std::size_t count) : stream_(stream), count_(count) {}
  cudaStream_t stream_ = nullptr;
  T* first_ = nullptr;
  std::size_t count_ = 0;
};

}  // namespace edgesplat::core
