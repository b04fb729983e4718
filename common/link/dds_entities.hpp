// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to common/link: the only header that shows DDS.

#include "common/base/result.hpp"
#include "common/link/chunk_path.hpp"

#include "dds/dds.h"

#include <functional>
#include <memory>
#include <string>
#include <utility>

namespace edgesplat::link {

/// Owns a DDS entity and everything below it. Single-owner.
class DdsEntity {
 public:
  DdsEntity() = default;
  explicit DdsEntity(dds_entity_t handle) : handle_(handle) {}
  DdsEntity(DdsEntity&& other) noexcept : handle_(std::exchange(other.handle_, 0)) {}
  DdsEntity& operator=(DdsEntity&& other) noexcept {
    std::swap(handle_, other.handle_);
    return *this;
  }
  ~DdsEntity() {
    if (handle_ > 0) (void)dds_delete(handle_);
  }
  [[nodiscard]] dds_entity_t get() const { return handle_; }
  [[nodiscard]] bool valid() const { return handle_ > 0; }

 private:
  dds_entity_t handle_ = 0;
};

/// Called on Cyclone's own threads when data or peers came or went; must return at once.
using WakeFunction = std::function<void()>;

/// edgesplat/up/keyframe and so on.
[[nodiscard]] std::string topic_name(Role sender, Lane lane);
[[nodiscard]] Result<DdsEntity> create_participant(int domain);
/// A writer or reader of the lane's topic with the lane's quality of service. `wake` must outlive it.
[[nodiscard]] Result<DdsEntity> create_writer(const DdsEntity& participant, Role sender, Lane lane,
                                              const WakeFunction* wake);
[[nodiscard]] Result<DdsEntity> create_reader(const DdsEntity& participant, Role sender, Lane lane,
                                              const WakeFunction* wake);

/// Waits at most 20 ms for the network; kBusy when that was not enough.
[[nodiscard]] WriteOutcome write_chunk(const DdsEntity& writer, const ChunkHeader& header,
                                       std::span<const std::byte> payload);
/// Takes one chunk, if there is one. False: nothing was there.
bool take_chunk(const DdsEntity& reader, const ChunkHandler& handle);
[[nodiscard]] bool has_reader(const DdsEntity& writer);

}  // namespace edgesplat::link
