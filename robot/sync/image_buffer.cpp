// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/sync/image_buffer.hpp"

#include <algorithm>

namespace edgesplat::sync {

bool ImageBuffer::push(HostTime t, const sensor::CameraFrame& frame) {
  if (newest_seen_ && t <= *newest_seen_) return false;
  newest_seen_ = t;
  images_.push_back({t, {frame.image, frame.exposure_s, frame.gain_db, frame.sequence}});
  bytes_ += frame.image->values.size();
  while (images_.size() > max_images_ || (bytes_ > max_bytes_ && images_.size() > 1)) {
    forget(images_.front());
    images_.pop_front();
    ++overflow_;
  }
  return true;
}

std::optional<HostTime> ImageBuffer::earliest() const {
  if (images_.empty()) return std::nullopt;
  return images_.front().t;
}

GroupImage ImageBuffer::take_earliest() {
  forget(images_.front());
  GroupImage image = std::move(images_.front().image);
  images_.pop_front();
  return image;
}

std::uint64_t ImageBuffer::drop_until(HostTime t) {
  std::uint64_t dropped = 0;
  for (; !images_.empty() && images_.front().t <= t; ++dropped) {
    forget(images_.front());
    images_.pop_front();
  }
  return dropped;
}

std::optional<GroupImage> ImageBuffer::take_nearest(HostTime t, nanoseconds tolerance) {
  const auto distance = [t](const Waiting& waiting) { return std::chrono::abs(waiting.t - t); };
  const auto nearest =
      std::min_element(images_.begin(), images_.end(),
                       [&](const Waiting& a, const Waiting& b) { return distance(a) < distance(b); });
  if (nearest == images_.end() || distance(*nearest) > tolerance) return std::nullopt;
  forget(*nearest);
  GroupImage image = std::move(nearest->image);
  images_.erase(nearest);
  return image;
}

void ImageBuffer::forget(const Waiting& waiting) {
  bytes_ -= waiting.image.image->values.size();
}

}  // namespace edgesplat::sync
