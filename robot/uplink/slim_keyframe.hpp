// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/map/keyframe.hpp"

#include <cstddef>

namespace edgesplat::uplink {

/// The same keyframe with about `target_bytes` encoded: half for the points, of which every so manieth stays,
/// the rest for the picture, which is compressed again at a lower quality where it is larger. Quality does
/// not fall under 40, so the target may be missed. 0, or small enough already: the keyframe as it is. A
/// picture that cannot be decoded stays as it is.
[[nodiscard]] map::Keyframe slim_keyframe(const map::Keyframe& keyframe, std::size_t target_bytes);

}  // namespace edgesplat::uplink
