// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/link/dds_transport.hpp"

#include "common/link/dds_chunk_path.hpp"
#include "common/link/link_end.hpp"

#include <random>

namespace edgesplat::link {
namespace {

std::uint64_t random_session() {
  std::random_device source;
  return (static_cast<std::uint64_t>(source()) << 32U) | source() | 1U;
}

}  // namespace

Result<std::unique_ptr<Transport>> open_dds_transport(std::shared_ptr<DdsDomain> domain,
                                                      const DdsTransportOptions& options,
                                                      const Clock& clock) {
  const LinkConfig& config = domain->config();
  LinkEndOptions end_options;
  end_options.role = options.role;
  end_options.robot = options.robot;
  end_options.session = options.session != 0 ? options.session : random_session();
  end_options.send = send_limits(config);
  end_options.inbox_messages = config.inbox_messages;
  end_options.impair = config.impair;
  end_options.name = config.interface + ", domain " + std::to_string(config.domain);
  auto end = std::make_unique<LinkEnd>(end_options, clock);
  EDGESPLAT_TRY(auto path, open_dds_path(std::move(domain), options.role, end->waker()));
  end->attach(std::move(path));
  end->start();
  return end;
}

}  // namespace edgesplat::link
