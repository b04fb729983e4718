// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "server/app/service_notify.hpp"

#include "common/base/unique_fd.hpp"

#include <sys/socket.h>
#include <sys/un.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstdlib>
#include <system_error>

namespace edgesplat::app {

ServiceNotify ServiceNotify::from_environment() {
  const char* socket = std::getenv("NOTIFY_SOCKET");
  return ServiceNotify(socket == nullptr ? "" : socket);
}

Status ServiceNotify::send(std::string_view state) const {
  if (socket_.empty()) return {};
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if ((socket_[0] != '/' && socket_[0] != '@') || socket_.size() >= sizeof address.sun_path)
    return fail(Errc::kInvalidArgument, "NOTIFY_SOCKET is no socket's name: " + socket_);
  std::copy(socket_.begin(), socket_.end(), address.sun_path);
  if (socket_[0] == '@') address.sun_path[0] = '\0';
  const UniqueFd fd(::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + socket_.size());
  const auto sent = fd.valid() ? ::sendto(fd.get(), state.data(), state.size(), MSG_NOSIGNAL,
                                          reinterpret_cast<const sockaddr*>(&address), size)
                               : -1;
  if (sent == static_cast<ssize_t>(state.size())) return {};
  return fail(Errc::kIo, "cannot tell the service manager " + std::string(state) + ": " +
                             std::generic_category().message(errno));
}

}  // namespace edgesplat::app
