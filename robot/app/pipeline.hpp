// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/thread/bounded_queue.hpp"
#include "common/thread/worker.hpp"
#include "robot/app/sensing_chain.hpp"

#include <functional>
#include <memory>
#include <optional>

namespace edgesplat::app {

/// What happens when a stage cannot follow: live sensors cannot wait, a recording can.
enum class Backpressure { kDropOldest, kWait };

/// The sensing chain with a worker a stage and bounded queues between them. Measurements go in from any
/// thread. Thread-safe but for finish(), which belongs to the owner.
class Pipeline {
 public:
  /// `on_pose` is called on the tracking worker for every tracked frame; it must be quick.
  using PoseListener = std::function<void(const TrackedFrame&)>;

  Pipeline(SensingChain& chain, Backpressure backpressure, PoseListener on_pose, metrics::Registry& metrics);
  ~Pipeline();
  Pipeline(const Pipeline&) = delete;
  Pipeline& operator=(const Pipeline&) = delete;

  /// Waits while the queue is full under Backpressure::kWait; otherwise the oldest measurement is dropped and
  /// counted.
  void push(sensor::Measurement measurement);
  /// No more measurements: lets every stage finish what it has, then returns. Idempotent.
  void finish();

 private:
  void publish_queue_counters();

  SensingChain& chain_;
  PoseListener on_pose_;
  metrics::Registry& metrics_;
  thread::BoundedQueue<sensor::Measurement> measurements_;
  thread::BoundedQueue<ReadyGroup> groups_;
  thread::BoundedQueue<TrackedFrame> frames_;
  std::optional<thread::Worker> sync_worker_;
  std::optional<thread::Worker> tracking_worker_;
  std::optional<thread::Worker> keyframe_worker_;
};

}  // namespace edgesplat::app
