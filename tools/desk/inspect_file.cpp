// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/io/bag_source.hpp"
#include "tools/desk/inspection.hpp"

namespace edgesplat::desk {

Result<Inspection> inspect_file(const std::filesystem::path& path) {
  const std::string ending = path.extension().string();
  if (ending == ".mcap") return inspect_recording(path);
  if (io::is_bag(path)) return inspect_bag(path);
  if (ending == ".ply" || ending == ".spz" || ending == ".splat") return inspect_cloud(path);
  if (ending == ".tum" || ending == ".txt") return inspect_trajectory(path);
  return fail(Errc::kInvalidArgument,
              "cannot tell what " + path.string() +
                  " is: expected a name ending in .mcap, .bag, .db3, .ply, .spz, .splat, .tum or .txt");
}

}  // namespace edgesplat::desk
