// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/map/keyframe.hpp"
#include "common/sensor/image.hpp"

#include <optional>

namespace edgesplat::io {

/// The picture of a keyframe to train on; nothing for a keyframe without picture or camera. kCorrupt for one
/// that does not decode or is not of its camera's size.
[[nodiscard]] Result<std::optional<sensor::ImageRgb8>> decode_picture(const map::Keyframe& keyframe);

}  // namespace edgesplat::io
