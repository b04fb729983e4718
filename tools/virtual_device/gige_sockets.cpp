// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/virtual_device/gige_sockets.hpp"

#include <sys/socket.h>

#include <cerrno>
#include <cstring>

namespace edgesplat::virtual_device {
namespace {

Result<UniqueFd> bound_socket(std::uint32_t address, std::uint16_t port, const std::string& text) {
  UniqueFd socket(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  if (!socket.valid())
    return fail(Errc::kIo, std::string("cannot open a UDP socket: ") + std::strerror(errno));
  const int on = 1;
  if (address == INADDR_BROADCAST)
    (void)::setsockopt(socket.get(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof(on));
  const sockaddr_in at = to_sockaddr({address, port});
  if (::bind(socket.get(), reinterpret_cast<const sockaddr*>(&at), sizeof(at)) != 0) {
    return fail(Errc::kIo, "the virtual camera cannot have UDP " + text + ":" + std::to_string(port) + ": " +
                               std::strerror(errno) + "; is another one running? Give it another address");
  }
  return socket;
}

}  // namespace

sockaddr_in to_sockaddr(GigePeer peer) {
  sockaddr_in out{};
  out.sin_family = AF_INET;
  out.sin_addr.s_addr = htonl(peer.address);
  out.sin_port = htons(peer.port);
  return out;
}

Result<GigeSockets> GigeSockets::open(std::uint32_t address, const std::string& text) {
  GigeSockets sockets;
  EDGESPLAT_TRY(sockets.control, bound_socket(address, kGvcpPort, text));
  EDGESPLAT_TRY(sockets.broadcasts, bound_socket(INADDR_BROADCAST, kGvcpPort, "255.255.255.255"));
  EDGESPLAT_TRY(sockets.stream, bound_socket(address, 0, text));
  return sockets;
}

}  // namespace edgesplat::virtual_device
