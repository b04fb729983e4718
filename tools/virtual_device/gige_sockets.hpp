// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/base/unique_fd.hpp"
#include "tools/virtual_device/gige_device.hpp"

#include <netinet/in.h>

#include <cstdint>
#include <string>

namespace edgesplat::virtual_device {

/// What a virtual camera is reached through.
struct GigeSockets {
  UniqueFd control;     ///< UDP port 3956 of its own address
  UniqueFd broadcasts;  ///< what is asked of every camera; shared with the machine's other virtual ones
  UniqueFd stream;      ///< frames leave here

  /// kIo where the port is taken or the address (host order) is not this machine's; `text` names it.
  static Result<GigeSockets> open(std::uint32_t address, const std::string& text);
};

[[nodiscard]] sockaddr_in to_sockaddr(GigePeer peer);

}  // namespace edgesplat::virtual_device
