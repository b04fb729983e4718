// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/link/lane.hpp"

namespace edgesplat::link {

std::string_view to_string(Lane lane) {
  switch (lane) {
    case Lane::kHeartbeat:
      return "heartbeat";
    case Lane::kAck:
      return "ack";
    case Lane::kRequest:
      return "request";
    case Lane::kDelta:
      return "delta";
    case Lane::kKeyframe:
      return "keyframe";
    case Lane::kSpool:
      return "spool";
    case Lane::kProbe:
      return "probe";
  }
  return "unknown";
}

}  // namespace edgesplat::link
