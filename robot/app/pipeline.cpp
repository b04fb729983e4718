// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/app/pipeline.hpp"

#include <utility>

namespace edgesplat::app {
namespace {

// 2 s of Mid-360 packets, IMU samples and images; 1 s of groups.
constexpr std::size_t kMeasurements = 8192;
constexpr std::size_t kGroups = 10;
constexpr std::size_t kFrames = 10;

thread::Overflow overflow_of(Backpressure backpressure) {
  return backpressure == Backpressure::kWait ? thread::Overflow::kBlock : thread::Overflow::kDropOldest;
}

}  // namespace

Pipeline::Pipeline(SensingChain& chain, Backpressure backpressure, PoseListener on_pose,
                   metrics::Registry& metrics)
    : chain_(chain),
      on_pose_(std::move(on_pose)),
      metrics_(metrics),
      measurements_({kMeasurements}, overflow_of(backpressure)),
      groups_({kGroups}, overflow_of(backpressure)),
      frames_({kFrames}, overflow_of(backpressure)) {
  keyframe_worker_.emplace(thread::Worker::consume<TrackedFrame>(
      "keyframe", frames_, [this](const TrackedFrame& frame) { chain_.keyframe(frame); }));
  tracking_worker_.emplace(thread::Worker::consume<ReadyGroup>("tracking", groups_, [this](ReadyGroup ready) {
    std::optional<TrackedFrame> frame = chain_.track(std::move(ready));
    if (!frame) return;
    on_pose_(*frame);
    frames_.push(std::move(*frame));
  }));
  sync_worker_.emplace(thread::Worker::consume<sensor::Measurement>(
      "sync", measurements_, [this](sensor::Measurement measurement) {
        for (ReadyGroup& ready : chain_.sync(std::move(measurement))) groups_.push(std::move(ready));
      }));
}

Pipeline::~Pipeline() {
  finish();
}

void Pipeline::push(sensor::Measurement measurement) {
  measurements_.push(std::move(measurement));
}

void Pipeline::finish() {
  if (!sync_worker_) return;
  measurements_.close();
  sync_worker_->join();
  for (ReadyGroup& ready : chain_.flush()) groups_.push(std::move(ready));
  groups_.close();
  tracking_worker_->join();
  frames_.close();
  keyframe_worker_->join();
  sync_worker_.reset();
  publish_queue_counters();
}

void Pipeline::publish_queue_counters() {
  metrics_.counter("queue.measurements.dropped").add(measurements_.stats().dropped);
  metrics_.counter("queue.groups.dropped").add(groups_.stats().dropped);
  metrics_.counter("queue.frames.dropped").add(frames_.stats().dropped);
  metrics_.gauge("queue.measurements.most").set(static_cast<double>(measurements_.stats().most_items));
  metrics_.gauge("queue.groups.most").set(static_cast<double>(groups_.stats().most_items));
  metrics_.gauge("queue.frames.most").set(static_cast<double>(frames_.stats().most_items));
}

}  // namespace edgesplat::app
