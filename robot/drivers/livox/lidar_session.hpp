// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/time/time.hpp"
#include "robot/drivers/livox/data_watch.hpp"
#include "robot/drivers/livox/endpoint.hpp"
#include "robot/drivers/livox/lidar_event.hpp"
#include "robot/drivers/livox/pending_request.hpp"
#include "robot/drivers/livox/sdk1_command.hpp"
#include "robot/drivers/livox/utc_feed.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace edgesplat::livox {

struct LidarSessionConfig {
  std::string serial_number;            ///< the unit to use; empty: the first that answers
  std::optional<Ipv4> address;          ///< where it is; empty: it is searched for
  std::vector<std::string> neighbours;  ///< serial numbers or addresses that others of this robot serve
  bool has_imu = true;
  ReturnMode return_mode = ReturnMode::kFirst;  ///< SDK1
  bool feeds_utc = false;                       ///< a pulse-per-second line without serial time: tell it UTC
  std::uint16_t points_port = 56301;            ///< of this host, all four
  std::uint16_t imu_port = 56401;
  std::uint16_t control_port = 56101;
  std::uint16_t push_port = 56201;
};

/// This host's address as a LiDAR sees it; nothing where no way leads there.
using HostTowards = std::function<std::optional<Ipv4>(const Ipv4& lidar)>;

/// What a LiDAR says of itself.
struct LidarHealth {
  std::uint8_t work_state = 0;
  std::string sync = "unknown";       ///< none, ptp, gps, pps, abnormal
  std::int64_t time_offset_ns = 0;    ///< SDK2: its clock minus the master's
  double core_temperature_deg = 0.0;  ///< SDK2
};

/// Brings one LiDAR up and keeps it up: finds it, tells it where to send, starts it, and does so again when
/// its data stop for half a second, it was restarted or has another address. One serial number is one LiDAR;
/// others on the wire are told of once and left alone. A pure state machine: messages and the time go in,
/// datagrams and events come out. Single-owner.
class LidarSession {
 public:
  struct Outgoing {
    Endpoint to;  ///< kBroadcast: to everyone on the LiDAR's network
    std::vector<std::byte> bytes;
  };

  virtual ~LidarSession() = default;
  LidarSession(const LidarSession&) = delete;
  LidarSession& operator=(const LidarSession&) = delete;

  /// A datagram of kControl or kPush.
  virtual void on_control(Channel channel, const Endpoint& from, std::span<const std::byte> datagram,
                          HostTime now) = 0;
  /// A good packet of kPoints or kImu came from the unit.
  void on_data(Channel channel, HostTime now);
  /// Does what is due; returns when it wants to be called again at the latest.
  [[nodiscard]] HostTime step(HostTime now);
  /// Ends what the protocol lets end; call before the sockets close.
  virtual void stop(HostTime now) = 0;

  /// Data from elsewhere belong to another LiDAR, or to nobody.
  [[nodiscard]] bool is_from_unit(const Ipv4& sender) const { return unit_ && unit_->at.ip == sender; }
  /// A rising edge of the pulse-per-second line; without, the wall clock's whole seconds are taken.
  [[nodiscard]] UtcFeed& utc_feed() { return utc_feed_; }
  [[nodiscard]] std::vector<Outgoing> take_outgoing() { return std::exchange(outgoing_, {}); }
  [[nodiscard]] std::vector<LidarEvent> take_events() { return std::exchange(events_, {}); }
  [[nodiscard]] const LidarHealth& health() const { return health_; }
  [[nodiscard]] const LidarSessionCounters& counters() const { return counters_; }
  [[nodiscard]] const LidarSessionConfig& config() const { return config_; }

 protected:
  /// How patient the protocol is.
  struct Pace {
    nanoseconds answer_timeout;   ///< then a request is repeated, four times at most
    nanoseconds search_period;    ///< between two searches
    nanoseconds pause_after_all;  ///< no repetition was answered: the search begins after this
  };
  LidarSession(LidarSessionConfig config, HostTowards host_towards, Pace pace)
      : config_(std::move(config)),
        host_towards_(std::move(host_towards)),
        watch_(config_.has_imu),
        pending_(pace.answer_timeout, 5),
        pace_(pace) {}

  struct Unit {
    std::string serial_number;
    Endpoint at;  ///< where it takes commands
  };
  /// What else the protocol has to do by now; returns when it wants to be called again at the latest.
  [[nodiscard]] virtual HostTime step_protocol(HostTime now) = 0;
  /// Nobody is served yet: asks for the unit once.
  virtual void search(HostTime now) = 0;
  /// It should measure, but no data come.
  virtual void bring_up_again(HostTime now) = 0;
  virtual void send_utc(std::int64_t utc_ns) = 0;
  [[nodiscard]] virtual bool is_searching() const = 0;
  [[nodiscard]] virtual bool is_sampling() const = 0;
  virtual void become_searching() = 0;

  /// Forgets what was under way and searches, from `when` on.
  void search_from(HostTime when);
  /// Sends a request to the unit and waits for its acknowledgement.
  void ask(std::uint32_t sequence, std::vector<std::byte> bytes, HostTime now);
  void send(const Endpoint& to, std::vector<std::byte> bytes);
  void tell(LidarEventKind kind, std::string detail);
  /// Whether this is the unit to use; one that is not, and is no neighbour, is told of once.
  [[nodiscard]] bool is_wanted(const std::string& serial_number, const Ipv4& ip);
  /// Takes note of the unit and of an address that changed.
  void meet(const std::string& serial_number, const Endpoint& at);
  /// Tells a sync that changed.
  void note_sync(std::string sync);
  /// Tells once, until it is heard again, that the unit does not answer.
  void note_unreachable(const std::string& why);
  /// While searching: tells once when nobody has answered for some seconds.
  void note_nobody(HostTime now);
  void note_heard() { unreachable_ = false; }
  void note_sampling(HostTime now);

  LidarSessionConfig config_;
  HostTowards host_towards_;
  DataWatch watch_;
  UtcFeed utc_feed_;
  PendingRequest pending_;
  std::optional<Unit> unit_;
  LidarHealth health_;
  LidarSessionCounters counters_;

 private:
  void step_pending(HostTime now);
  void on_silence(HostTime now);
  [[nodiscard]] bool waits_for_data() const { return is_sampling() && watch_.silent(); }

  Pace pace_;
  HostTime next_search_{};                 ///< while it is searched for
  HostTime next_rearm_ = HostTime::max();  ///< while it should measure and is silent
  nanoseconds rearm_pause_ = std::chrono::seconds(1);
  std::vector<Outgoing> outgoing_;
  std::vector<LidarEvent> events_;
  std::vector<std::string> foreign_;  ///< serial numbers that were told of, a few
  bool unreachable_ = false;
  std::optional<HostTime> searching_since_;  ///< without having met a unit
};

}  // namespace edgesplat::livox
