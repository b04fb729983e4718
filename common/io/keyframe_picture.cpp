// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/io/keyframe_picture.hpp"

#include "common/io/image_file.hpp"

#include <utility>

namespace edgesplat::io {

Result<std::optional<sensor::ImageRgb8>> decode_picture(const map::Keyframe& keyframe) {
  if (!keyframe.image || !keyframe.camera) return std::nullopt;
  EDGESPLAT_TRY(sensor::ImageRgb8 picture, decode_rgb8(keyframe.image->bytes));
  if (picture.width_px != keyframe.camera->model.width_px ||
      picture.height_px != keyframe.camera->model.height_px) {
    return fail(Errc::kCorrupt, "it is not of its camera's size");
  }
  return std::optional(std::move(picture));
}

}  // namespace edgesplat::io
