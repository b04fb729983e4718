// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/drivers/frame_socket/frame_assembler.hpp"

#include <algorithm>

namespace edgesplat::frame_socket {

std::span<const std::byte> FrameAssembler::unread() const {
  return std::span(buffer_).subspan(read_);
}

void FrameAssembler::append(std::span<const std::byte> bytes) {
  buffer_.erase(buffer_.begin(), buffer_.begin() + static_cast<std::ptrdiff_t>(read_));
  read_ = 0;
  buffer_.insert(buffer_.end(), bytes.begin(), bytes.end());
}

std::optional<EncodedFrame> FrameAssembler::next() {
  while (true) {
    if (!header_) {
      skip_to_magic();
      if (unread().size() < kHeaderBytes) return std::nullopt;
      const auto header = decode_header(unread().first(kHeaderBytes));
      if (!header) {
        ++counters_.bad_headers;
        skip(1);
        continue;
      }
      header_ = *header;
    }
    if (unread().size() < kHeaderBytes + header_->payload_bytes) return std::nullopt;
    const auto payload = unread().subspan(kHeaderBytes, header_->payload_bytes);
    EncodedFrame frame{*header_, {}};
    header_.reset();
    if (crc32(payload) != frame.header.payload_crc32) {
      ++counters_.bad_payloads;
      // A flipped bit, or bytes are missing: then the next message begins inside this one.
      skip(kMagic.size());
      continue;
    }
    frame.payload.assign(payload.begin(), payload.end());
    read_ += kHeaderBytes + payload.size();
    return frame;
  }
}

void FrameAssembler::restart() {
  buffer_.clear();
  read_ = 0;
  header_.reset();
}

/// Leaves unread() empty, at a magic, or at what may be the beginning of one.
void FrameAssembler::skip_to_magic() {
  const auto bytes = unread();
  const auto at = std::search(bytes.begin(), bytes.end(), kMagic.begin(), kMagic.end());
  auto distance = static_cast<std::size_t>(at - bytes.begin());
  if (at == bytes.end()) {
    // Keep an end that begins like the magic.
    std::size_t tail = std::min(bytes.size(), kMagic.size() - 1);
    while (tail > 0 &&
           !std::equal(bytes.end() - static_cast<std::ptrdiff_t>(tail), bytes.end(), kMagic.begin()))
      --tail;
    distance = bytes.size() - tail;
  }
  skip(distance);
}

void FrameAssembler::skip(std::size_t bytes) {
  read_ += bytes;
  counters_.bytes_skipped += bytes;
}

}  // namespace edgesplat::frame_socket
