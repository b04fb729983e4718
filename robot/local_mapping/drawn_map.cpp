// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/local_mapping/drawn_map.hpp"

#include <algorithm>
#include <utility>

namespace edgesplat::local_mapping {
namespace {

using Cloud = gaussian::GaussianCloud;

bool is_identity(const geometry::RigidTransform& b_from_a) {
  return b_from_a.translation_m.isZero(0.0) && b_from_a.rotation.vec().isZero(0.0);
}

/// Colours of the lower degree get zeros for the higher bands.
void append_colours(const Cloud& from, Cloud& to) {
  const std::size_t width = from.sh_floats_each();
  for (std::size_t row = 0; row < from.size(); ++row) {
    const auto first = from.sh.begin() + static_cast<std::ptrdiff_t>(row * width);
    to.sh.insert(to.sh.end(), first, first + static_cast<std::ptrdiff_t>(width));
    to.sh.resize(to.sh.size() + to.sh_floats_each() - width, 0.0F);
  }
}

void append(const Cloud& from, Cloud& to) {
  const auto copy = [](const auto& source, auto& target) {
    target.insert(target.end(), source.begin(), source.end());
  };
  copy(from.ids, to.ids);
  copy(from.means_m, to.means_m);
  copy(from.log_scales, to.log_scales);
  copy(from.quats_xyzw, to.quats_xyzw);
  copy(from.opacity_logits, to.opacity_logits);
  copy(from.anchors, to.anchors);
  append_colours(from, to);
}

}  // namespace

std::shared_ptr<const Cloud> moved(std::shared_ptr<const Cloud> in_a,
                                   const geometry::RigidTransform& b_from_a) {
  if (is_identity(b_from_a)) return in_a;
  auto in_b = std::make_shared<Cloud>(*in_a);
  for (std::size_t row = 0; row < in_b->size(); ++row) {
    Eigen::Map<Eigen::Vector3f> mean_m(&in_b->means_m[3 * row]);
    mean_m = (b_from_a * Eigen::Vector3d(mean_m.cast<double>())).cast<float>();
    Eigen::Map<Eigen::Quaternionf> quat(&in_b->quats_xyzw[4 * row]);
    quat = (b_from_a.rotation * quat.cast<double>()).normalized().cast<float>();
  }
  return in_b;
}

DrawnMap::DrawnMap()
    : resident_in_map_(std::make_shared<const Cloud>()),
      provisional_in_odom_(resident_in_map_),
      provisional_in_map_(resident_in_map_),
      drawn_{resident_in_map_, {}} {}

void DrawnMap::set_resident(std::shared_ptr<const Cloud> in_map, const map::MapFromOdom& map_from_odom) {
  const std::lock_guard lock(parts_mutex_);
  const bool corrected = map_from_odom.version != map_from_odom_.version;
  if (in_map == resident_in_map_ && !corrected) return;
  resident_in_map_ = std::move(in_map);
  map_from_odom_ = map_from_odom;
  if (corrected) provisional_in_map_ = moved(provisional_in_odom_, map_from_odom_.map_from_odom);
  merge();
}

void DrawnMap::set_provisional(std::shared_ptr<const Cloud> in_odom) {
  const std::lock_guard lock(parts_mutex_);
  provisional_in_odom_ = std::move(in_odom);
  provisional_in_map_ = moved(provisional_in_odom_, map_from_odom_.map_from_odom);
  merge();
}

void DrawnMap::merge() {
  std::shared_ptr<const Cloud> all = resident_in_map_;
  if (resident_in_map_->size() == 0) {
    all = provisional_in_map_;
  } else if (provisional_in_map_->size() > 0) {
    auto both = std::make_shared<Cloud>();
    both->sh_degree = std::max(resident_in_map_->sh_degree, provisional_in_map_->sh_degree);
    append(*resident_in_map_, *both);
    append(*provisional_in_map_, *both);
    all = std::move(both);
  }
  const std::lock_guard lock(drawn_mutex_);
  drawn_ = {std::move(all), map_from_odom_.map_from_odom};
}

std::shared_ptr<const Cloud> DrawnMap::snapshot() const {
  return placed().in_map;
}

DrawnMap::Placed DrawnMap::placed() const {
  const std::lock_guard lock(drawn_mutex_);
  return drawn_;
}

}  // namespace edgesplat::local_mapping
