// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/link/ack.hpp"

#include "common/base/bytes.hpp"

namespace edgesplat::link {
namespace {

constexpr std::uint32_t kMagic = 0x31414345U;  // "ECA1"
constexpr std::uint16_t kVersion = 1;
constexpr std::size_t kAck_bytes = 4 + 2 + 1 + 8 + 4 + 8 + 8;

}  // namespace

std::vector<std::byte> encode_ack(const Ack& ack) {
  ByteWriter out;
  out.write(kMagic);
  out.write(kVersion);
  out.write(static_cast<std::uint8_t>(ack.lane));
  out.write(ack.session);
  out.write(ack.next_train);
  out.write(ack.received_bits);
  out.write(ack.received_total);
  return out.take();
}

Result<Ack> decode_ack(std::span<const std::byte> bytes) {
  if (bytes.size() != kAck_bytes) return fail(Errc::kCorrupt, "an acknowledgement has the wrong length");
  ByteReader in(bytes);
  if (in.read<std::uint32_t>() != kMagic || in.read<std::uint16_t>() != kVersion) {
    return fail(Errc::kCorrupt, "not an acknowledgement of a version this program reads");
  }
  const auto lane = in.read<std::uint8_t>();
  if (lane >= kLaneCount) return fail(Errc::kCorrupt, "an acknowledgement of an unknown lane");
  Ack ack;
  ack.lane = static_cast<Lane>(lane);
  ack.session = in.read<std::uint64_t>();
  ack.next_train = in.read<std::uint32_t>();
  ack.received_bits = in.read<std::uint64_t>();
  ack.received_total = in.read<std::uint64_t>();
  return ack;
}

bool ReceivedTrains::is_new(std::uint32_t train) const {
  if (train < next_) return false;
  const std::uint32_t offset = train - next_;
  return offset >= kWindow || (((received_ | given_up_) >> offset) & 1U) == 0;
}

void ReceivedTrains::received(std::uint32_t train) {
  if (!is_new(train)) return;
  make_window_reach(train);
  received_ |= std::uint64_t{1} << (train - next_);
  ++received_total_;
  shift_settled();
}

void ReceivedTrains::give_up(std::uint32_t train) {
  if (!is_new(train)) return;
  make_window_reach(train);
  given_up_ |= std::uint64_t{1} << (train - next_);
  ++lost_total_;
  shift_settled();
}

void ReceivedTrains::make_window_reach(std::uint32_t train) {
  if (train - next_ < kWindow) return;
  const bool first = received_total_ == 0 && lost_total_ == 0;
  const std::uint32_t shift = train - next_ - (kWindow - 1);
  for (std::uint32_t i = 0; i < shift && i < kWindow; ++i) {
    if (!first && (((received_ | given_up_) >> i) & 1U) == 0) ++lost_total_;
  }
  if (!first && shift > kWindow) lost_total_ += shift - kWindow;
  received_ = shift < kWindow ? received_ >> shift : 0;
  given_up_ = shift < kWindow ? given_up_ >> shift : 0;
  next_ += shift;
}

void ReceivedTrains::shift_settled() {
  while (((received_ | given_up_) & 1U) != 0) {
    received_ >>= 1U;
    given_up_ >>= 1U;
    ++next_;
  }
}

}  // namespace edgesplat::link
