// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/unique_fd.hpp"
#include "common/time/time.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <stop_token>
#include <string>

namespace edgesplat::aravis {

/// A camera that answered a discovery command, by its bootstrap registers.
struct FoundCamera {
  std::string address;        ///< IPv4 that it has now
  std::uint64_t mac = 0;      ///< 48 bits
  std::string maker;          ///< printable ASCII, as the next one; other bytes are '?'
  std::string serial_number;  ///< may be empty: the standard allows that
};

/// Two answers of one camera, wherever it is: same maker and serial number, or where it has none the same
/// network card.
[[nodiscard]] bool is_same_camera(const FoundCamera& a, const FoundCamera& b);

/// GigE Vision's discovery command, which every camera answers whoever controls it (GVCP on UDP port 3956).
[[nodiscard]] std::array<std::byte, 8> discovery_command(std::uint16_t id);
/// Nothing for bytes that are no answer to the command with that id, whatever they are.
[[nodiscard]] std::optional<FoundCamera> read_discovery_answer(std::span<const std::byte> datagram,
                                                               std::uint16_t id);

/// Asks cameras whether they are there, in milliseconds: libaravis would wait for seconds. Thread-bound.
class GvcpFinder {
 public:
  GvcpFinder();
  /// Who is at that IPv4 address? Nothing when nobody answers in time, or it is no address.
  [[nodiscard]] std::optional<FoundCamera> ask(const std::string& address, const std::stop_token& stop,
                                               nanoseconds timeout);
  /// The first that `wanted` accepts of all cameras on this machine's networks.
  using Wanted = std::function<bool(const FoundCamera&)>;
  [[nodiscard]] std::optional<FoundCamera> find(const Wanted& wanted, const std::stop_token& stop,
                                                nanoseconds timeout);

 private:
  [[nodiscard]] std::array<std::byte, 8> next_question();
  [[nodiscard]] std::optional<FoundCamera> wait(const Wanted& wanted, const std::stop_token& stop,
                                                nanoseconds timeout);

  UniqueFd socket_;
  std::uint16_t id_ = 0;  ///< of the newest question: an answer to an earlier one tells nothing
};

}  // namespace edgesplat::aravis
