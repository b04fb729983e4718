// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/link/train.hpp"

#include "common/base/bytes.hpp"
#include "common/base/crc32c.hpp"
#include "common/link/transport.hpp"

#include <algorithm>

namespace edgesplat::link {

std::uint32_t chunk_count(std::size_t bytes) {
  return static_cast<std::uint32_t>((bytes + kChunk_bytes - 1) / kChunk_bytes);
}

std::span<const std::byte> chunk_at(std::span<const std::byte> message, std::uint32_t index) {
  const std::size_t first = index * kChunk_bytes;
  return message.subspan(first, std::min(kChunk_bytes, message.size() - first));
}

std::uint32_t chunk_crc32c(const ChunkHeader& header, std::span<const std::byte> payload) {
  ByteWriter fields;
  fields.write(header.robot.value);
  fields.write(header.session);
  fields.write(header.train);
  fields.write(header.index);
  fields.write(header.attempt);
  fields.write(header.count);
  fields.write(header.total_bytes);
  fields.write(header.message_crc32c);
  return crc32c(payload, crc32c(fields.bytes()));
}

bool plausible(const ChunkHeader& header, std::size_t payload_bytes) {
  if (header.train == 0 || header.total_bytes == 0 || header.total_bytes > kMaxMessage_bytes) return false;
  if (header.count != chunk_count(header.total_bytes) || header.index >= header.count) return false;
  const bool last = header.index + 1 == header.count;
  return payload_bytes == (last ? header.total_bytes - header.index * kChunk_bytes : kChunk_bytes);
}

TrainAssembler::Added TrainAssembler::add(const ChunkHeader& header, std::span<const std::byte> payload,
                                          HostTime now) {
  Added added;
  added.outcome = Outcome::kCorrupt;
  if (!plausible(header, payload.size())) return added;
  auto found = open_.find(header.train);
  if (found != open_.end()) {
    const ChunkHeader& first = found->second.first;
    if (first.total_bytes != header.total_bytes || first.message_crc32c != header.message_crc32c) {
      drop(found);
      return added;
    }
    if (!found->second.pieces[header.index].empty()) {
      added.outcome = Outcome::kDuplicate;
      return added;
    }
  }
  make_room(payload.size(), found == open_.end(), added.lost_trains);
  found = open_.try_emplace(header.train).first;
  Train& train = found->second;
  if (train.pieces.empty()) {
    train.first = header;
    train.pieces.resize(header.count);
  }
  train.pieces[header.index].assign(payload.begin(), payload.end());
  ++train.arrived;
  train.bytes += payload.size();
  train.touched = now;
  held_bytes_ += payload.size();
  added.outcome = Outcome::kPart;
  if (train.arrived == header.count) {
    added.message = join(train);
    const bool intact = crc32c(added.message) == header.message_crc32c;
    added.outcome = intact ? Outcome::kComplete : Outcome::kCorrupt;
    drop(found);
  }
  return added;
}

std::vector<std::uint32_t> TrainAssembler::expire(HostTime now) {
  std::vector<std::uint32_t> lost;
  for (auto it = open_.begin(); it != open_.end();) {
    const auto here = it++;
    if (now - here->second.touched < limits_.timeout) continue;
    lost.push_back(here->first);
    drop(here);
  }
  return lost;
}

std::vector<PartialTrain> TrainAssembler::partial(std::size_t most) const {
  std::vector<PartialTrain> parts;
  for (const auto& [number, train] : open_) {
    if (parts.size() >= most) break;
    PartialTrain part;
    part.train = number;
    while (part.first_missing < train.pieces.size() && !train.pieces[part.first_missing].empty())
      ++part.first_missing;
    for (std::uint32_t i = 0; i < 64 && part.first_missing + i < train.pieces.size(); ++i) {
      if (!train.pieces[part.first_missing + i].empty()) part.came_bits |= std::uint64_t{1} << i;
    }
    parts.push_back(part);
  }
  return parts;
}

void TrainAssembler::drop(Trains::iterator train) {
  held_bytes_ -= train->second.bytes;
  open_.erase(train);
}

void TrainAssembler::make_room(std::size_t more_bytes, bool new_train, std::vector<std::uint32_t>& lost) {
  while (!open_.empty() &&
         ((new_train && open_.size() >= limits_.trains) || held_bytes_ + more_bytes > limits_.bytes)) {
    const auto oldest = std::min_element(open_.begin(), open_.end(), [](const auto& a, const auto& b) {
      return a.second.touched < b.second.touched;
    });
    lost.push_back(oldest->first);
    drop(oldest);
  }
}

std::vector<std::byte> TrainAssembler::join(const Train& train) {
  std::vector<std::byte> message;
  message.reserve(train.bytes);
  for (const auto& piece : train.pieces) message.insert(message.end(), piece.begin(), piece.end());
  return message;
}

}  // namespace edgesplat::link
