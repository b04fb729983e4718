// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/link/ack.hpp"
#include "common/map/ids.hpp"
#include "common/time/time.hpp"

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

namespace edgesplat::link {

/// Payload of one sample: small enough that a link of 0.2 Mbit/s carries one in 0.6 s and what it does shows
/// in time, far under the 64 KB above which a lost one stalls the link.
inline constexpr std::size_t kChunk_bytes = 15 * 1024;

/// Where a piece belongs in its message: a message is cut into a train of chunks.
struct ChunkHeader {
  map::RobotId robot;
  std::uint64_t session = 0;
  std::uint32_t train = 0;  ///< 1, 2, 3... within robot, session and lane
  std::uint32_t index = 0;
  std::uint32_t count = 0;
  std::uint32_t total_bytes = 0;
  std::uint32_t message_crc32c = 0;
  std::uint32_t attempt = 1;       ///< 1 for the first sending of this chunk
  std::uint32_t chunk_crc32c = 0;  ///< of all the fields above and the payload
};

/// How many chunks a message of `bytes` becomes.
[[nodiscard]] std::uint32_t chunk_count(std::size_t bytes);
/// The chunk at `index` < chunk_count(message.size()).
[[nodiscard]] std::span<const std::byte> chunk_at(std::span<const std::byte> message, std::uint32_t index);
/// CRC32C of the header's other fields and the payload: what ChunkHeader::chunk_crc32c has to be.
[[nodiscard]] std::uint32_t chunk_crc32c(const ChunkHeader& header, std::span<const std::byte> payload);
/// The header agrees with itself and with the limits, and the payload has the length that its index asks for.
[[nodiscard]] bool plausible(const ChunkHeader& header, std::size_t payload_bytes);

struct AssemblerLimits {
  std::size_t trains = 32;  ///< begun at a time; over it the one that stands longest is lost
  std::size_t bytes = std::size_t{64} << 20U;      ///< of received pieces, the same
  nanoseconds timeout = std::chrono::seconds(15);  ///< without a new piece a train is lost
};

/// Puts the messages of one sender and lane together again, whatever the order of their chunks. Holds only
/// what arrived, never what a header announces. Pure; single-owner.
class TrainAssembler {
 public:
  enum class Outcome : std::uint8_t {
    kPart,       ///< more to come
    kComplete,   ///< `message` is whole and its CRC32C right
    kDuplicate,  ///< that piece was there
    kCorrupt,    ///< the header makes no sense or the whole fails its CRC32C; the train is given up
  };
  struct Added {
    Outcome outcome = Outcome::kPart;
    std::vector<std::byte> message;
    std::vector<std::uint32_t> lost_trains;  ///< given up to make room
  };

  explicit TrainAssembler(const AssemblerLimits& limits) : limits_(limits) {}
  Added add(const ChunkHeader& header, std::span<const std::byte> payload, HostTime now);
  /// Gives up what has stood for too long and returns its numbers.
  std::vector<std::uint32_t> expire(HostTime now);
  /// What has come of each message that is not whole, oldest number first.
  [[nodiscard]] std::vector<PartialTrain> partial(std::size_t most) const;
  [[nodiscard]] std::size_t trains() const { return open_.size(); }
  [[nodiscard]] std::size_t held_bytes() const { return held_bytes_; }

 private:
  struct Train {
    ChunkHeader first;                           ///< of the chunk that came first; the others must agree
    std::vector<std::vector<std::byte>> pieces;  ///< by index, empty where missing
    std::uint32_t arrived = 0;
    std::size_t bytes = 0;
    HostTime touched{};
  };
  using Trains = std::map<std::uint32_t, Train>;
  void drop(Trains::iterator train);
  void make_room(std::size_t more_bytes, bool new_train, std::vector<std::uint32_t>& lost);
  static std::vector<std::byte> join(const Train& train);

  AssemblerLimits limits_;
  Trains open_;
  std::size_t held_bytes_ = 0;
};

}  // namespace edgesplat::link
