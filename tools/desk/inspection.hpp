// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"

#include <filesystem>
#include <string>

namespace edgesplat::desk {

/// What a file holds: a table for people and the same as JSON (one object, its "kind" says which).
struct Inspection {
  std::string text;
  std::string json;
};

/// Channels with counts, rates and gaps; attachments; damage.
[[nodiscard]] Result<Inspection> inspect_recording(const std::filesystem::path& path);
/// The same of a ROS bag: topics with types, counts, rates, gaps.
[[nodiscard]] Result<Inspection> inspect_bag(const std::filesystem::path& path);
/// Points or Gaussians (in .ply told apart by the names of the properties): number, extent, colour or degree.
[[nodiscard]] Result<Inspection> inspect_cloud(const std::filesystem::path& path);
/// Poses, duration, path, rate, gaps.
[[nodiscard]] Result<Inspection> inspect_trajectory(const std::filesystem::path& path);

/// One of the above by the file's ending (.mcap, .bag, .db3, .ply, .spz, .splat, .tum or .txt, or a folder of
/// bags); kInvalidArgument for another one.
[[nodiscard]] Result<Inspection> inspect_file(const std::filesystem::path& path);

/// Writes an attachment of a recording to `target`. kNotFound names the attachments that are there.
[[nodiscard]] Status extract_attachment(const std::filesystem::path& recording, const std::string& name,
                                        const std::filesystem::path& target);

}  // namespace edgesplat::desk
