// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "server/app/service_notify.hpp"

#include "common/base/unique_fd.hpp"
#include "test/support/temp_dir.hpp"

#include <gtest/gtest.h>

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstddef>

namespace edgesplat::app {
namespace {

/// The service manager's end: a datagram socket of the test's own.
class Manager {
 public:
  explicit Manager(const std::string& name) : fd_(::socket(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK, 0)) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::copy(name.begin(), name.end(), address.sun_path);
    if (name[0] == '@') address.sun_path[0] = '\0';
    const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + name.size());
    EXPECT_EQ(::bind(fd_.get(), reinterpret_cast<const sockaddr*>(&address), size), 0);
  }
  std::string next() {
    std::array<char, 256> bytes{};
    const ssize_t got = ::recv(fd_.get(), bytes.data(), bytes.size(), 0);
    return got < 0 ? "" : std::string(bytes.data(), static_cast<std::size_t>(got));
  }

 private:
  UniqueFd fd_;
};

TEST(ServiceNotify, SaysWhatTheProtocolAsksFor) {
  const test::TempDir folder;
  const std::string abstract = "@edgesplat-test-" + std::to_string(::getpid());
  for (const std::string& name : {(folder.path() / "notify").string(), abstract}) {
    Manager manager(name);
    const ServiceNotify notify(name);
    EXPECT_TRUE(notify.ready().has_value());
    EXPECT_TRUE(notify.watchdog().has_value());
    EXPECT_TRUE(notify.stopping().has_value());
    EXPECT_EQ(manager.next(), "READY=1");
    EXPECT_EQ(manager.next(), "WATCHDOG=1");
    EXPECT_EQ(manager.next(), "STOPPING=1");
    EXPECT_EQ(manager.next(), "");
  }
}

TEST(ServiceNotify, IsSilentWhenNobodyListens) {
  EXPECT_TRUE(ServiceNotify("").ready().has_value());
}

TEST(ServiceNotify, SaysWhyItCannot) {
  EXPECT_EQ(ServiceNotify("/nonexistent/socket").ready().error().code, Errc::kIo);
  EXPECT_EQ(ServiceNotify("vsock:2:1").ready().error().code, Errc::kInvalidArgument);
  EXPECT_EQ(ServiceNotify("/" + std::string(200, 'x')).ready().error().code, Errc::kInvalidArgument);
}

}  // namespace
}  // namespace edgesplat::app
