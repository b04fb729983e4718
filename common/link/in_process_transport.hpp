// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/link/link_end.hpp"
#include "common/link/transport.hpp"

#include <memory>

namespace edgesplat::link {

struct InProcessLink {
  std::unique_ptr<Transport> robot;
  std::unique_ptr<Transport> server;
};

/// Both ends of a link inside one process, without network and threads: what one end sends is at once what
/// the other can receive. For tests and for lockstep. At most `inbox_messages` wait at each end; more are
/// dropped and counted as inbox_drops of the sending end. The ends may be destroyed in any order.
[[nodiscard]] InProcessLink make_in_process_link(map::RobotId robot, std::size_t inbox_messages = 256);

struct InProcessEnds {
  std::unique_ptr<LinkEnd> robot;
  std::unique_ptr<LinkEnd> server;
};

/// The same with everything that the real link has (chunks, acknowledgements, repetition, impairments,
/// bandwidth) but the network: start() both ends, or call their step() in virtual time. The roles are set
/// here.
[[nodiscard]] InProcessEnds make_in_process_ends(LinkEndOptions robot, LinkEndOptions server,
                                                 const Clock& clock);

}  // namespace edgesplat::link
