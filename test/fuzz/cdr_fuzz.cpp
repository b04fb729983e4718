// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/base/check.hpp"
#include "common/io/ros_messages.hpp"

#include <cstddef>
#include <cstdint>

/// Decodes the payload as each message type; what is accepted must survive encoding and decoding again.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* first, std::size_t size) {
  using namespace edgesplat::io;
  const auto payload = std::as_bytes(std::span(first, size));
  if (const auto message = decode_raw_datagram(payload)) {
    EDGESPLAT_CHECK(decode_raw_datagram(encode(*message))->datagram.size() == message->datagram.size(),
                    "datagram");
  }
  if (const auto message = decode_frame_meta(payload)) {
    EDGESPLAT_CHECK(decode_frame_meta(encode(*message))->sequence == message->sequence, "frame meta");
  }
  if (const auto message = decode_compressed_image(payload)) {
    const auto again = encode(*message);
    EDGESPLAT_CHECK(decode_compressed_image(again)->format == message->format, "compressed image");
  }
  if (const auto message = decode_pose_stamped(payload)) {
    EDGESPLAT_CHECK(decode_pose_stamped(encode(*message))->frame_id == message->frame_id, "pose");
  }
  return 0;
}
