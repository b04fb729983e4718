// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/core/cuda_status.cuh"
#include "kernels/core/stream.hpp"

namespace edgesplat::core {

Result<Stream> Stream::create() {
  Stream stream;
  EDGESPLAT_CUDA_TRY(cudaStreamCreateWithFlags(&stream.handle_, cudaStreamNonBlocking));
  return stream;
}

Stream::~Stream() {
  if (handle_ != nullptr) cudaStreamDestroy(handle_);
}

Status Stream::synchronise() const {
  return cuda_status(cudaStreamSynchronize(handle_), "waiting for the GPU");
}

}  // namespace edgesplat::core
