// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/gaussian/gaussian_cloud.hpp"
#include "common/map/delta.hpp"
#include "test/support/map_samples.hpp"
#include "test/support/random.hpp"

#include <numeric>
#include <optional>
#include <utility>
#include <vector>

namespace edgesplat::test {

/// A map that grows, moves and loses Gaussians at every change, and now and then has a pose corrected.
class ChangingMap {
 public:
  explicit ChangingMap(std::uint64_t seed) : random_(seed) { cloud_ = random_gaussians(0, 1); }

  void change() {
    auto fresh = random_gaussians(60, ++changes_);
    for (std::size_t row = 0; row < fresh.size(); ++row) {
      fresh.ids[row] = gaussian::GaussianId(40000, changes_ * 1000 + row);
      cloud_.append_row(fresh, row);
    }
    for (float& v : cloud_.means_m) v += static_cast<float>(random_.uniform(-0.1, 0.1));
    for (std::size_t i = 0; i < 5 && cloud_.size() > 100; ++i) {
      removed_.push_back(cloud_.ids[i]);
      cloud_.copy_row(cloud_.size() - 1, i);
      cloud_.resize(cloud_.size() - 1);
    }
  }
  /// Due after every twentieth change.
  [[nodiscard]] std::optional<map::PoseCorrection> correction() {
    if (changes_ % 20 != 0) return std::nullopt;
    map::PoseCorrection correction{3, changes_ / 20, {}, {}};
    correction.new_map_from_body.translation_m = random_.vector(0.5);
    correction.new_map_from_body.rotation = Eigen::AngleAxisd(0.01, Eigen::Vector3d::UnitZ());
    return correction;
  }

  [[nodiscard]] const gaussian::GaussianCloud& cloud() const { return cloud_; }
  [[nodiscard]] std::vector<gaussian::GaussianId> take_removed() { return std::exchange(removed_, {}); }
  [[nodiscard]] std::vector<std::uint32_t> all_rows() const {
    std::vector<std::uint32_t> rows(cloud_.size());
    std::iota(rows.begin(), rows.end(), 0U);
    return rows;
  }

 private:
  Random random_;
  std::uint32_t changes_ = 0;
  gaussian::GaussianCloud cloud_;
  std::vector<gaussian::GaussianId> removed_;
};

}  // namespace edgesplat::test
