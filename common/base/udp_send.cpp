// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/base/udp_send.hpp"

#include <sys/socket.h>

#include <array>
#include <cstring>

namespace edgesplat {

bool send_datagram(int socket, const sockaddr_in& to, in_addr source, std::span<const std::byte> bytes) {
  sockaddr_in address = to;
  iovec content{const_cast<std::byte*>(bytes.data()), bytes.size()};
  alignas(cmsghdr) std::array<std::byte, CMSG_SPACE(sizeof(in_pktinfo))> control{};
  msghdr header{};
  header.msg_name = &address;
  header.msg_namelen = sizeof(address);
  header.msg_iov = &content;
  header.msg_iovlen = 1;
  if (source.s_addr != INADDR_ANY) {
    header.msg_control = control.data();
    header.msg_controllen = control.size();
    cmsghdr* note = CMSG_FIRSTHDR(&header);
    note->cmsg_level = IPPROTO_IP;
    note->cmsg_type = IP_PKTINFO;
    note->cmsg_len = CMSG_LEN(sizeof(in_pktinfo));
    in_pktinfo info{};
    info.ipi_spec_dst = source;
    std::memcpy(CMSG_DATA(note), &info, sizeof(info));
  }
  return ::sendmsg(socket, &header, MSG_NOSIGNAL | MSG_DONTWAIT) == static_cast<ssize_t>(bytes.size());
}

}  // namespace edgesplat
