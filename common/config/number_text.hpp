// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace edgesplat::config {

/// A double as TOML with the fewest digits that read back as the same value: 0.1, 5.0, 1e+20, inf, nan.
[[nodiscard]] std::string number_text(double value);

}  // namespace edgesplat::config
