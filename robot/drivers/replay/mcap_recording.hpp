// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/io/mcap_reader.hpp"
#include "robot/drivers/replay/replay_source.hpp"

#include <filesystem>
#include <memory>

namespace edgesplat::replay {

/// Opens a recording of ours (topics and attachments: ARCHITECTURE.md). Raw Livox datagrams go through the
/// same LivoxSource as those of a socket; each picture is paired with the meta message of its stamp. A
/// truncated file gives what is whole. `path` is for messages. kInvalidArgument where rig.toml or all of our
/// topics are missing.
[[nodiscard]] Result<std::unique_ptr<ReplaySource::Reader>> open_mcap_recording(
    io::McapReader reader, const std::filesystem::path& path);
/// It has a topic of ours: else it may be a recording of ROS.
[[nodiscard]] bool is_own_recording(const io::McapReader& reader);

}  // namespace edgesplat::replay
