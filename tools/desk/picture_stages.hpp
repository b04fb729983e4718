// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/desk/scene.hpp"

#include <span>
#include <vector>

namespace edgesplat::desk {

/// The picture and its camera at half the size (odd sizes rounded): means of the colours, nearest depths, and
/// a pixel counts where all that it was made of counted.
[[nodiscard]] ScenePicture half_size(const ScenePicture& picture);

/// Pictures at full and at half size; the small ones are made when they are first asked for. Single-owner.
class PictureStages {
 public:
  /// The pictures must outlive this.
  explicit PictureStages(std::span<const ScenePicture* const> pictures)
      : full_(pictures), half_(pictures.size()) {}

  /// `shrink` 1 or 2. Valid until forget_small().
  [[nodiscard]] const ScenePicture& at(std::size_t index, int shrink);
  /// Gives their memory back.
  void forget_small() { half_.assign(full_.size(), {}); }
  [[nodiscard]] std::size_t size() const { return full_.size(); }

 private:
  std::span<const ScenePicture* const> full_;
  std::vector<ScenePicture> half_;
};

}  // namespace edgesplat::desk
