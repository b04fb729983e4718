// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"

namespace edgesplat::core {

/// Fine where the driver finds a CUDA device, else kUnavailable with the driver's reason.
[[nodiscard]] Status probe_cuda();

}  // namespace edgesplat::core
