// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/drivers/serial_imu/serial_protocol.hpp"

#include "common/base/bytes.hpp"

#include <algorithm>

namespace edgesplat::serial_imu {
namespace {

constexpr std::byte kFirst{0xA5}, kSecond{0x5A};
constexpr std::uint8_t kInertial = 1, kPulse = 2;

std::vector<std::byte> enclose(std::uint8_t type, std::uint16_t sequence,
                               std::span<const std::byte> payload) {
  ByteWriter out;
  out.write(static_cast<std::uint8_t>(kFirst));
  out.write(static_cast<std::uint8_t>(kSecond));
  out.write(type);
  out.write(static_cast<std::uint8_t>(payload.size()));
  out.write(sequence);
  out.write_bytes(payload);
  out.write(crc16_ccitt(out.bytes().subspan(2)));
  return out.take();
}

std::optional<Frame> decode(std::uint8_t type, std::uint16_t sequence, std::span<const std::byte> payload) {
  ByteReader in(payload);
  if (type == kInertial && payload.size() == kSampleBytes) {
    InertialFrame frame;
    frame.sequence = sequence;
    frame.stamp = sensor_time_from_ns(in.read<std::int64_t>());
    for (int i = 0; i < 3; ++i) frame.gyro_radps[i] = in.read<float>();
    for (int i = 0; i < 3; ++i) frame.accel_mps2[i] = in.read<float>();
    return frame;
  }
  if (type == kPulse && payload.size() == kPulseBytes) {
    PulseFrame frame;
    frame.sequence = sequence;
    frame.number = in.read<std::uint32_t>();
    in.skip(sizeof(std::uint32_t));
    frame.edge_ns = in.read<std::int64_t>();
    return frame;
  }
  return std::nullopt;
}

}  // namespace

std::uint16_t crc16_ccitt(std::span<const std::byte> bytes) {
  unsigned crc = 0xFFFF;
  for (const std::byte byte : bytes) {
    crc ^= std::to_integer<unsigned>(byte) << 8U;
    for (int bit = 0; bit < 8; ++bit) crc = (crc & 0x8000U) != 0 ? crc << 1U ^ 0x1021U : crc << 1U;
  }
  return static_cast<std::uint16_t>(crc);
}

std::vector<std::byte> encode(const InertialFrame& frame) {
  ByteWriter payload;
  payload.write(to_ns(frame.stamp));
  for (int i = 0; i < 3; ++i) payload.write(frame.gyro_radps[i]);
  for (int i = 0; i < 3; ++i) payload.write(frame.accel_mps2[i]);
  return enclose(kInertial, frame.sequence, payload.bytes());
}

std::vector<std::byte> encode(const PulseFrame& frame) {
  ByteWriter payload;
  payload.write(frame.number);
  payload.write(std::uint32_t{0});
  payload.write(frame.edge_ns);
  return enclose(kPulse, frame.sequence, payload.bytes());
}

void FrameDecoder::append(std::span<const std::byte> bytes) {
  waiting_.insert(waiting_.end(), bytes.begin(), bytes.end());
}

void FrameDecoder::skip(std::size_t bytes) {
  waiting_.erase(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(bytes));
  counters_.bytes_skipped += bytes;
}

std::optional<Frame> FrameDecoder::next() {
  while (true) {
    const auto begin = std::ranges::find(waiting_, kFirst) - waiting_.begin();
    if (begin > 0) skip(static_cast<std::size_t>(begin));
    if (waiting_.size() >= 2 && waiting_[1] != kSecond) {
      skip(1);
      continue;
    }
    if (waiting_.size() < kHeaderBytes) return std::nullopt;
    const auto payload_bytes = std::to_integer<std::size_t>(waiting_[3]);
    const std::size_t checked = kHeaderBytes + payload_bytes;
    if (waiting_.size() < checked + kChecksumBytes) return std::nullopt;
    const auto all = std::span<const std::byte>(waiting_);
    ByteReader tail(all.subspan(checked, kChecksumBytes));
    if (tail.read<std::uint16_t>() != crc16_ccitt(all.subspan(2, checked - 2))) {
      ++counters_.bad_checksums;
      skip(1);
      continue;
    }
    ByteReader header(all.subspan(2, kHeaderBytes - 2));
    const auto type = header.read<std::uint8_t>();
    header.skip(1);
    const auto sequence = header.read<std::uint16_t>();
    auto frame = decode(type, sequence, all.subspan(kHeaderBytes, payload_bytes));
    waiting_.erase(waiting_.begin(),
                   waiting_.begin() + static_cast<std::ptrdiff_t>(checked + kChecksumBytes));
    if (frame) return frame;
    ++counters_.unknown;
  }
}

}  // namespace edgesplat::serial_imu
