// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "robot/drivers/frame_socket/frame_protocol.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace edgesplat::frame_socket {

/// A message whose checksums are right; the picture is still compressed.
struct EncodedFrame {
  FrameHeader header;
  std::vector<std::byte> payload;
};

struct AssemblerCounters {
  std::uint64_t bad_headers = 0;    ///< behind a magic
  std::uint64_t bad_payloads = 0;   ///< wrong checksum: the whole message is dropped
  std::uint64_t bytes_skipped = 0;  ///< while looking for the next message
};

/// Cuts a byte stream into messages: partial reads, several messages a read, resynchronisation on the next
/// magic after damage. Memory grows with the bytes received, up to one message. Single-owner.
class FrameAssembler {
 public:
  /// Appends what was read from the socket. Call next() until it gives nothing before the next append.
  void append(std::span<const std::byte> bytes);
  [[nodiscard]] std::optional<EncodedFrame> next();
  /// The connection is new: forget the rest of the old one.
  void restart();
  [[nodiscard]] const AssemblerCounters& counters() const { return counters_; }

 private:
  [[nodiscard]] std::span<const std::byte> unread() const;
  void skip_to_magic();
  void skip(std::size_t bytes);

  std::vector<std::byte> buffer_;
  std::size_t read_ = 0;               ///< bytes of buffer_ that are done with
  std::optional<FrameHeader> header_;  ///< of the message at read_, checked
  AssemblerCounters counters_;
};

}  // namespace edgesplat::frame_socket
