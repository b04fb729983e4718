// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"

#include <filesystem>
#include <optional>
#include <system_error>
#include <utility>

namespace edgesplat::quality {

/// A network (Lpips, StaticMask) that not every machine has: nothing where `folder` is empty or absent, the
/// errors of Network::load() where it is there.
template <typename Network>
[[nodiscard]] Result<std::optional<Network>> load_where_there(const std::filesystem::path& folder) {
  std::error_code error;
  if (folder.empty() || !std::filesystem::exists(folder, error)) return std::optional<Network>();
  EDGESPLAT_TRY(auto network, Network::load(folder));
  return std::optional(std::move(network));
}

}  // namespace edgesplat::quality
