// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/base/unique_fd.hpp"
#include "test/support/child_process.hpp"
#include "test/support/temp_dir.hpp"
#include "test/support/test_domain.hpp"

#include <gtest/gtest.h>

#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdlib>

namespace edgesplat {
namespace {

/// The next message to the service manager, or nothing within 30 s.
std::string next_message(int fd) {
  pollfd ready{fd, POLLIN, 0};
  if (::poll(&ready, 1, 30'000) != 1) return "";
  std::array<char, 256> bytes{};
  const ssize_t got = ::recv(fd, bytes.data(), bytes.size(), 0);
  return got < 0 ? "" : std::string(bytes.data(), static_cast<std::size_t>(got));
}

TEST(ServerService, TheProgramSaysThatItIsReadyAliveAndEnding) {
  const test::TempDir folder;
  const std::string name = (folder.path() / "notify").string();
  const UniqueFd manager(::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  ASSERT_LT(name.size(), sizeof address.sun_path);
  std::copy(name.begin(), name.end(), address.sun_path);
  ASSERT_EQ(::bind(manager.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  ASSERT_EQ(::setenv("NOTIFY_SOCKET", name.c_str(), 1), 0);
  test::ChildProcess server({std::string(EDGESPLAT_BINARY_DIR) + "/bin/edgesplat-server", "--domain",
                             std::to_string(test::test_domain()), "--out", folder.path().string()});
  ::unsetenv("NOTIFY_SOCKET");
  EXPECT_EQ(next_message(manager.get()), "READY=1");
  EXPECT_EQ(next_message(manager.get()), "WATCHDOG=1");
  server.signal(SIGTERM);
  std::string last = next_message(manager.get());
  while (last == "WATCHDOG=1") last = next_message(manager.get());
  EXPECT_EQ(last, "STOPPING=1");
  EXPECT_EQ(server.wait(std::chrono::seconds(20)), 0);
}

}  // namespace
}  // namespace edgesplat
