// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/io/bag_source.hpp"
#include "common/io/mcap_reader.hpp"

namespace edgesplat::io {

/// The ROS topics of an MCAP file (message encoding cdr or ros1). Errors: those of McapReader::open.
[[nodiscard]] Result<std::unique_ptr<BagSource>> open_mcap_bag(const std::filesystem::path& path);
/// The same of a file that is open already.
[[nodiscard]] std::unique_ptr<BagSource> to_mcap_bag(McapReader reader);

}  // namespace edgesplat::io
