// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/map/ids.hpp"

#include <filesystem>

namespace edgesplat::stream {

/// The number of this start of the server: one more than the file says (0 where there is none) and than
/// `known`, an epoch that is known to be used, in case the file was lost; written back
/// to the disk before it is returned, so that no two starts share it. Errors: kIo; kCorrupt where the file is
/// not a number (never started over silently: a used epoch would make robots drop every delta).
[[nodiscard]] Result<map::Epoch> next_epoch(const std::filesystem::path& path, map::Epoch known = {});

}  // namespace edgesplat::stream
