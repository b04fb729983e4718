// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/map/delta.hpp"
#include "common/map/map_request.hpp"
#include "common/time/time.hpp"

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <span>
#include <vector>

namespace edgesplat::map {

/// Which deltas are in the map: everything of `epoch` up to `seq`.
struct MapPosition {
  Epoch epoch;
  std::uint64_t seq = 0;
};

struct DeltaGateConfig {
  std::size_t max_held_deltas = 64;  ///< that wait for one before them
  std::size_t max_held_bytes = std::size_t{64} << 20U;
  double resend_after_s = 0.1;          ///< a gap this old asks for a resend, again every twice that
  double snapshot_after_s = 2.0;        ///< a gap without progress for so long asks for a snapshot
  double snapshot_again_after_s = 1.0;  ///< and again, while none has begun
};

/// Lets deltas through exactly once and in order; holds what comes early and knows what to ask for. Pure;
/// single-owner.
class DeltaGate {
 public:
  enum class Verdict : std::uint8_t {
    kApply,       ///< it is next
    kDuplicate,   ///< seen before
    kHeld,        ///< one before it is missing
    kOld,         ///< of an older epoch or a map left behind
    kForeign,     ///< of another map of this epoch, and not its beginning
    kNeedsReset,  ///< of a newer epoch, but not its beginning; or too many are held
  };

  explicit DeltaGate(const DeltaGateConfig& config) : config_(config) {}

  Verdict place(const DeltaHeader& header, std::span<const std::byte> bytes, HostTime now);
  /// A delta that kApply was said of (or take_next() gave) is in the map.
  void applied(const DeltaHeader& header, HostTime now);
  /// The held delta whose turn it is.
  std::optional<std::vector<std::byte>> take_next();
  /// The server says, with nothing on its way to us, how far it is.
  void server_at(const MapPosition& position, HostTime now);
  /// The map turned out to be wrong, or a checked delta could not be applied.
  void ask_snapshot() { wants_snapshot_ = true; }
  /// What to ask for now, a request for each gap; kind, epoch and numbers are filled in. Nothing while
  /// earlier requests may still be answered.
  std::vector<MapRequest> requests(HostTime now);

  [[nodiscard]] const MapPosition& position() const { return position_; }
  [[nodiscard]] std::size_t held() const { return held_.size(); }
  [[nodiscard]] std::size_t held_bytes() const { return held_bytes_; }

 private:
  struct Held {
    DeltaHeader header;
    std::vector<std::byte> bytes;
    HostTime since{};
    std::optional<HostTime> asked;  ///< for what is missing before it
  };
  [[nodiscard]] bool begins_anew(const DeltaHeader& header) const;
  Verdict hold(const DeltaHeader& header, std::span<const std::byte> bytes, HostTime now);
  void forget_settled();
  void note_gap(HostTime now);
  [[nodiscard]] bool snapshot_due(HostTime now);
  [[nodiscard]] bool resend_due(HostTime since, double patience_s, std::optional<HostTime>& asked,
                                HostTime now) const;
  [[nodiscard]] MapRequest request_of(RequestKind kind, std::uint64_t after, std::uint64_t until) const;

  const DeltaGateConfig config_;
  bool started_ = false;
  MapPosition position_;
  MapUuid map_;
  std::deque<MapUuid> former_maps_;     ///< the last few
  std::map<std::uint64_t, Held> held_;  ///< by seq, of the present map
  std::size_t held_bytes_ = 0;
  std::uint64_t server_seq_ = 0;        ///< as last said
  std::optional<HostTime> gap_since_;   ///< or since the last progress in it
  std::optional<HostTime> tail_asked_;  ///< for what is missing at the end
  bool newer_epoch_ = false;            ///< the server is ahead by a start
  bool wants_snapshot_ = false;
  std::optional<HostTime> snapshot_asked_;
};

}  // namespace edgesplat::map
