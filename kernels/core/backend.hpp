// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"

#include <cstdint>
#include <string_view>
#include <vector>

namespace edgesplat::core {

/// Where an operation runs. Every operation has a CPU backend; CUDA where it was compiled in and a device is
/// there.
enum class Backend : std::uint8_t { kCpu, kCuda };
[[nodiscard]] std::string_view to_string(Backend backend);

/// Whether this build contains CUDA code at all.
[[nodiscard]] bool built_with_cuda();

/// What can run here and now: the CPU, and CUDA where it is compiled in and the driver finds a device. Asks
/// the driver each time; call it once at start.
[[nodiscard]] std::vector<Backend> available_backends();

/// "cpu", "cuda", or "auto" for the fastest that is available. Errors: kInvalidConfig for another name,
/// kUnavailable with the reason (not compiled in, no device) where "cuda" cannot be had.
[[nodiscard]] Result<Backend> choose_backend(std::string_view name);

}  // namespace edgesplat::core
