// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/link/dds_chunk_path.hpp"

#include "common/link/dds_entities.hpp"

#include <array>
#include <utility>

namespace edgesplat::link {
namespace {

class DdsChunkPath final : public ChunkPath {
 public:
  DdsChunkPath(std::shared_ptr<DdsDomain> domain, std::function<void()> wake)
      : domain_(std::move(domain)), wake_(std::move(wake)) {}

  Status open(Role role) {
    EDGESPLAT_TRY(participant_, create_participant(domain_->config().domain));
    const Role far_end = role == Role::kRobot ? Role::kServer : Role::kRobot;
    for (const Lane lane : kLanes) {
      if (sends(role, lane)) {
        EDGESPLAT_TRY(writers_[index_of(lane)], create_writer(participant_, role, lane, &wake_));
      }
      if (receives(role, lane)) {
        EDGESPLAT_TRY(readers_[index_of(lane)], create_reader(participant_, far_end, lane, &wake_));
      }
    }
    return {};
  }

  WriteOutcome write(Lane lane, const ChunkHeader& header, std::span<const std::byte> payload) override {
    return write_chunk(writers_[index_of(lane)], header, payload);
  }
  bool take(Lane lane, const ChunkHandler& handle) override {
    const DdsEntity& reader = readers_[index_of(lane)];
    return reader.valid() && take_chunk(reader, handle);
  }
  [[nodiscard]] bool has_reader(Lane lane) const override {
    const DdsEntity& writer = writers_[index_of(lane)];
    return writer.valid() && link::has_reader(writer);
  }

 private:
  const std::shared_ptr<DdsDomain> domain_;
  const WakeFunction wake_;
  DdsEntity participant_;  ///< after what its listeners use
  std::array<DdsEntity, kLaneCount> writers_;
  std::array<DdsEntity, kLaneCount> readers_;
};

}  // namespace

Result<std::unique_ptr<ChunkPath>> open_dds_path(std::shared_ptr<DdsDomain> domain, Role role,
                                                 std::function<void()> wake) {
  auto path = std::make_unique<DdsChunkPath>(std::move(domain), std::move(wake));
  EDGESPLAT_TRY_STATUS(path->open(role));
  return path;
}

}  // namespace edgesplat::link
