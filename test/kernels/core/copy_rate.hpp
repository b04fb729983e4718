// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/core/stream.hpp"
#include "kernels/core/vram_pool.hpp"

#include <string>

namespace edgesplat::core {

/// Bytes a second, read and written together, that the device copies within its memory: what memory-bound
/// work is measured by. The best of some copies of 256 MiB.
[[nodiscard]] Result<double> copy_rate_bytes_per_s(const Stream& stream, VramPool& pool);

/// The device's name and its compute capability.
[[nodiscard]] Result<std::string> device_name();

}  // namespace edgesplat::core
