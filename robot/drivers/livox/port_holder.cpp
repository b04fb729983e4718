// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/drivers/livox/port_holder.hpp"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <system_error>

namespace edgesplat::livox {
namespace {

namespace fs = std::filesystem;

std::string read_text(const fs::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

/// Does one of the process's descriptors point to one of these "socket:[inode]" names?
bool holds_socket(const fs::path& process, const std::vector<std::string>& names) {
  std::error_code error;
  for (fs::directory_iterator at(process / "fd", error), end; !error && at != end; at.increment(error)) {
    std::error_code link_error;
    const std::string target = fs::read_symlink(at->path(), link_error).string();
    if (!link_error && std::find(names.begin(), names.end(), target) != names.end()) return true;
  }
  return false;
}

}  // namespace

std::vector<std::string> inodes_of_port(std::string_view udp_table, std::uint16_t port) {
  // sl local_address rem_address st tx:rx tr:when retrnsmt uid timeout inode ...; local_address = hex ip:port
  constexpr std::size_t kLocalAddress = 1;
  constexpr std::size_t kInode = 9;
  std::vector<std::string> inodes;
  std::istringstream lines{std::string(udp_table)};
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    const std::vector<std::string> columns{std::istream_iterator<std::string>(words), {}};
    if (columns.size() <= kInode) continue;
    const std::string& address = columns[kLocalAddress];
    const std::size_t colon = address.rfind(':');
    if (colon == std::string::npos) continue;
    std::uint32_t line_port = 0;
    const auto [rest, error] =
        std::from_chars(address.data() + colon + 1, address.data() + address.size(), line_port, 16);
    if (error == std::errc{} && rest == address.data() + address.size() && line_port == port)
      inodes.push_back(columns[kInode]);
  }
  return inodes;
}

std::optional<PortHolder> find_port_holder(std::uint16_t port) {
  std::vector<std::string> names;
  for (const char* table : {"/proc/net/udp", "/proc/net/udp6"})
    for (const std::string& inode : inodes_of_port(read_text(table), port))
      names.push_back("socket:[" + inode + "]");
  if (names.empty()) return std::nullopt;
  std::error_code error;
  for (fs::directory_iterator at("/proc", error), end; !error && at != end; at.increment(error)) {
    const std::string name = at->path().filename().string();
    PortHolder holder;
    const auto [rest, parse_error] = std::from_chars(name.data(), name.data() + name.size(), holder.pid);
    if (parse_error != std::errc{} || rest != name.data() + name.size()) continue;
    if (!holds_socket(at->path(), names)) continue;
    holder.program = read_text(at->path() / "comm");
    while (!holder.program.empty() && holder.program.back() == '\n') holder.program.pop_back();
    return holder;
  }
  return std::nullopt;
}

}  // namespace edgesplat::livox
