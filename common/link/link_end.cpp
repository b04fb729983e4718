// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/link/link_end.hpp"

#include "common/base/crc32c.hpp"
#include "common/log/log.hpp"

#include <algorithm>
#include <utility>

namespace edgesplat::link {
namespace {

constexpr nanoseconds kExpiryPeriod = std::chrono::seconds(1);  // unfinished messages are given up that often
constexpr nanoseconds kTickPeriod = std::chrono::milliseconds(200);  // of the estimators, while bytes fly
constexpr int kChunksInOneGo = 64;                                   // then what came is looked at again
constexpr std::size_t kMostPeers = 64;
constexpr nanoseconds kMostAckDelay = std::chrono::seconds(10);

}  // namespace

LinkEnd::LinkEnd(const LinkEndOptions& options, const Clock& clock)
    : options_(options),
      clock_(clock),
      sending_(options.session, options.send),
      inbox_({options.inbox_messages}, thread::Overflow::kDropNewest) {}

std::function<void()> LinkEnd::waker() {
  return [this] { sending_.wake(); };
}

void LinkEnd::attach(std::unique_ptr<ChunkPath> path) {
  const ImpairmentConfig& impair = options_.impair;
  if (!impair.active()) {
    path_ = std::move(path);
    return;
  }
  EDGESPLAT_LOG_WARN("link", "the link is made worse on purpose", "shaped", !impair.shape_at_s.empty(),
                     "delay_ms", impair.delay_ms, "loss", impair.loss, "duplicate", impair.duplicate,
                     "reorder", impair.reorder, "flip_bits", impair.flip_bits);
  auto impaired = std::make_unique<ImpairedPath>(impair, std::move(path), clock_);
  impaired_ = impaired.get();
  path_ = std::move(impaired);
}

void LinkEnd::start() {
  link_thread_.emplace("link", [this](const std::stop_token& stop) {
    if (stop.stop_requested()) return false;
    const nanoseconds sleep = step();
    if (sleep > nanoseconds(0)) sending_.wait_for_work(stop, sleep);
    return true;
  });
}

nanoseconds LinkEnd::step() {
  path_->pump(clock_.now());
  take_what_came();
  queue_acks();
  const LaneMask reachable = reachable_lanes();
  const bool more = send_chunks(reachable);
  send_probes(reachable);
  const HostTime now = clock_.now();
  if (now - expired_at_ >= kExpiryPeriod) {
    receiving_.expire(now);
    expired_at_ = now;
  }
  look_after_peers(now);
  return more ? nanoseconds(0) : time_to_sleep(now);
}

bool LinkEnd::send(Lane lane, map::RobotId robot, std::vector<std::byte> bytes) {
  if (!is_for_user(lane) || !sends(options_.role, lane)) return false;
  return sending_.push(lane, robot, std::move(bytes));
}

std::optional<Message> LinkEnd::receive(nanoseconds timeout) {
  auto message = inbox_.pop_for(timeout);
  if (message) sending_.wake();  // there is room again: what the path holds back may come in
  return message;
}

void LinkEnd::take_what_came() {
  for (const Lane lane : kLanes) {
    if (!receives(options_.role, lane)) continue;
    const auto handle = [&](const ChunkHeader& header, std::span<const std::byte> payload) {
      if (options_.role == Role::kRobot && header.robot != options_.robot) return;  // for another robot
      if (auto message = receiving_.add(lane, header, payload, clock_.now())) deliver(std::move(*message));
    };
    // With a full inbox the chunks stay in the path, which then holds the sender back.
    while ((!is_for_user(lane) || has_room()) && path_->take(lane, handle)) {
    }
  }
}

void LinkEnd::deliver(Message message) {
  if (message.lane == Lane::kAck) {
    on_acks(message);
  } else if (is_for_user(message.lane)) {
    // has_room() was asked and nobody else pushes; refused only when closed
    if (inbox_.push(std::move(message)) != thread::PushResult::kAccepted) ++inbox_drops_;
  }
}

void LinkEnd::on_acks(const Message& message) {
  const auto report = decode_acks(message.bytes);
  if (!report) {
    EDGESPLAT_LOG_DEBUG("link", "bad acknowledgement", "why", report.error().context);
    return;
  }
  PeerLink* from = peer(message.robot);
  if (report->session != options_.session || from == nullptr || !from->meet(message.session)) return;
  const HostTime now = clock_.now();
  BandwidthEstimator::Delivery delivery{report->delivered_bytes, 0, std::nullopt, 0};
  for (const Ack& ack : report->lanes) {
    if (!sends(options_.role, ack.lane)) continue;
    const nanoseconds came_after =
        std::clamp(nanoseconds(report->sent_ns - ack.newest_came_ns), nanoseconds(0), kMostAckDelay);
    const Flight::News news = reliable(ack.lane)
                                  ? sending_.on_ack(ack, came_after, message.robot, message.session, now)
                                  : from->on_single_ack(ack, came_after, now);
    if (news.round_trip) from->estimator.on_round_trip(*news.round_trip, now);
    if (urgent(ack.lane)) continue;
    from->estimator.on_loss(news.chunks_lost, news.chunks_came);
    if (delivery.came_ns == 0 || ack.newest_came_ns > delivery.came_ns) {
      delivery.came_ns = ack.newest_came_ns;
      delivery.sent = news.newest_sent;
    }
  }
  delivery.bytes_on_the_way = bytes_on_the_way(message.robot, *from, now);
  // A train is not over between its packets: its beginning alone would measure what the network lets through
  // at once.
  if (from->prober.more_follows()) delivery.bytes_on_the_way += options_.probe.packet_bytes;
  if (delivery.came_ns != 0) from->estimator.on_delivery(delivery, now);
}

void LinkEnd::queue_acks() {
  for (const auto& due : receiving_.take_due_acks(clock_.now())) {
    (void)sending_.push(Lane::kAck, due.robot, encode_acks(due.report));
  }
}

LaneMask LinkEnd::reachable_lanes() {
  LaneMask mask{};
  for (const Lane lane : kLanes) {
    bool& here = mask[index_of(lane)];
    here = sends(options_.role, lane) && path_->has_reader(lane);
    if (here && !reachable_before_[index_of(lane)]) sending_.start_over(lane);
  }
  reachable_before_ = mask;
  const bool now = mask[index_of(options_.role == Role::kRobot ? Lane::kKeyframe : Lane::kDelta)];
  if (connected_.exchange(now) != now) {
    EDGESPLAT_LOG_INFO("link", now ? "peer is there" : "peer is gone", "over", options_.name);
  }
  return mask;
}

bool LinkEnd::send_chunks(const LaneMask& reachable) {
  for (int i = 0; i < kChunksInOneGo; ++i) {
    const HostTime now = clock_.now();
    const auto part = sending_.next(reachable, now);
    if (!part) return false;
    const Lane lane = part->lane;
    const map::RobotId robot = part->header.robot;
    const std::uint32_t train = part->header.train;
    const std::size_t bytes = part->payload.size();
    PeerLink* to = peer(robot);
    const bool first = to != nullptr && bytes_on_the_way(robot, *to, now) == 0;
    const WriteOutcome outcome = path_->write(lane, part->header, part->payload);
    if (outcome == WriteOutcome::kBusy) {
      sending_.count_busy(lane);
      return !path_->next_event().has_value();  // who knows when it is free again says so
    }
    if (outcome == WriteOutcome::kRefused) sending_.count_write_failure(lane);
    sending_.sent(now);
    if (to == nullptr) continue;
    if (!reliable(lane)) to->sent_single(lane, train, now);
    if (!urgent(lane)) to->estimator.on_sent(now, bytes, first, sending_.bulk_waits(robot));
  }
  return true;
}

void LinkEnd::send_probes(const LaneMask& reachable) {
  if (options_.role != Role::kRobot) return;
  PeerLink* to = peer(options_.robot);
  Prober::Situation situation;
  situation.allowed = probing_allowed_.load() && reachable[index_of(Lane::kProbe)];
  HostTime now = clock_.now();
  situation.idle = bytes_on_the_way(options_.robot, *to, now) == 0 && !sending_.bulk_waits(options_.robot);
  situation.bytes_per_s = to->estimator.bytes_per_s();
  situation.confirmed_at = to->estimator.confirmed_at();
  while (to->prober.due(situation, now)) {
    send_probe(options_.robot, *to, now);
    now = clock_.now();
  }
}

void LinkEnd::send_probe(map::RobotId robot, PeerLink& to, HostTime now) {
  const std::vector<std::byte> padding(to.prober.config().packet_bytes);
  ChunkHeader header;
  header.robot = robot;
  header.session = options_.session;
  header.train = ++last_probe_;
  header.count = 1;
  header.total_bytes = static_cast<std::uint32_t>(padding.size());
  header.message_crc32c = crc32c(padding);
  header.chunk_crc32c = chunk_crc32c(header, padding);
  ++probes_.messages_offered;
  if (path_->write(Lane::kProbe, header, padding) != WriteOutcome::kWritten) {
    ++probes_.messages_dropped;
    return;
  }
  ++probes_.messages_sent;
  ++probes_.chunks_sent;
  probes_.bytes_sent += padding.size();
  to.sent_single(Lane::kProbe, header.train, now);
  // A train is one burst even where each packet arrives before the next leaves, and the sender holds it down.
  to.estimator.on_sent(now, padding.size(), to.prober.begins_train(), false);
}

PeerLink* LinkEnd::peer(map::RobotId robot) {
  const auto found = peers_.find(robot);
  if (found != peers_.end()) return &found->second;
  if (peers_.size() >= kMostPeers) return nullptr;
  return &peers_.try_emplace(robot, options_.bandwidth, options_.probe).first->second;
}

std::size_t LinkEnd::bytes_on_the_way(map::RobotId robot, const PeerLink& to, HostTime now) const {
  return sending_.bulk_bytes_on_the_way(robot) + to.probes_on_the_way(now) * options_.probe.packet_bytes;
}

void LinkEnd::look_after_peers(HostTime now) {
  for (auto& [robot, to] : peers_) {
    // Of what is sent again until it comes: probes may be lost for good.
    to.estimator.tick(now, sending_.bulk_bytes_on_the_way(robot));
    sending_.set_window(robot, to.window_bytes());
  }
  const std::lock_guard lock(shown_mutex_);
  for (const auto& [robot, to] : peers_) {
    LinkQuality& shown = shown_qualities_[robot];
    shown.bandwidth_bytes_per_s = to.estimator.bytes_per_s();
    const auto round_trip = to.estimator.round_trip();
    if (round_trip) shown.round_trip_ms = to_seconds(*round_trip) * 1e3;
    if (impaired_ != nullptr) shown.shaped_bytes_per_s = impaired_->shaped_bytes_per_s();
  }
  if (impaired_ != nullptr) shown_impairments_ = impaired_->counters();
  shown_probes_ = probes_;
}

nanoseconds LinkEnd::time_to_sleep(HostTime now) const {
  HostTime until = now + kExpiryPeriod;
  const auto no_later_than = [&](std::optional<HostTime> t) {
    if (t) until = std::min(until, *t);
  };
  no_later_than(path_->next_event());
  no_later_than(sending_.next_timeout());
  for (const auto& [robot, to] : peers_) {
    no_later_than(to.prober.next_event());
    if (bytes_on_the_way(robot, to, now) > 0) no_later_than(now + kTickPeriod);
  }
  return std::max(nanoseconds(0), until - now);
}

LinkCounters LinkEnd::counters() const {
  LinkCounters all = sending_.counters();
  const LinkCounters received = receiving_.counters();
  for (std::size_t i = 0; i < kLaneCount; ++i) {
    all[i].chunks_received = received[i].chunks_received;
    all[i].bytes_received = received[i].bytes_received;
    all[i].chunks_corrupt = received[i].chunks_corrupt;
    all[i].messages_received = received[i].messages_received;
    all[i].messages_corrupt = received[i].messages_corrupt;
    all[i].messages_lost = received[i].messages_lost;
  }
  all[index_of(Lane::kKeyframe)].inbox_drops = inbox_drops_.load();
  const std::lock_guard lock(shown_mutex_);
  LaneCounters& probes = all[index_of(Lane::kProbe)];
  probes.messages_offered = shown_probes_.messages_offered;
  probes.messages_dropped = shown_probes_.messages_dropped;
  probes.messages_sent = shown_probes_.messages_sent;
  probes.chunks_sent = shown_probes_.chunks_sent;
  probes.bytes_sent = shown_probes_.bytes_sent;
  return all;
}

LinkQuality LinkEnd::quality(map::RobotId robot) const {
  const std::lock_guard lock(shown_mutex_);
  const auto found = shown_qualities_.find(robot);
  return found == shown_qualities_.end() ? LinkQuality{} : found->second;
}

void LinkEnd::allow_probing(bool allowed) {
  if (probing_allowed_.exchange(allowed) != allowed) sending_.wake();
}

std::optional<ImpairmentCounters> LinkEnd::impairments() const {
  const std::lock_guard lock(shown_mutex_);
  return shown_impairments_;
}

void LinkEnd::close() {
  sending_.close();
  inbox_.close();
  if (link_thread_) {
    link_thread_->request_stop();
    link_thread_->join();
  }
}

}  // namespace edgesplat::link
