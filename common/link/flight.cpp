// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/link/flight.hpp"

#include <algorithm>
#include <utility>

namespace edgesplat::link {

bool Flight::has_room(std::size_t bytes) const {
  if (trains_.empty()) return true;
  return trains_.size() < limits_.trains && held_bytes_ + bytes <= limits_.bytes;
}

void Flight::begin(const ChunkHeader& header, std::vector<std::byte> message) {
  held_bytes_ += message.size();
  trains_.push_back({header, std::move(message), std::vector<Chunk>(header.count), 0});
}

bool Flight::has_unsent() const {
  return !trains_.empty() && trains_.back().next_unsent < trains_.back().header.count;
}

std::size_t Flight::unsent_bytes() const {
  if (!has_unsent()) return 0;
  const Train& last = trains_.back();
  return last.message.size() - std::min(last.message.size(), kChunk_bytes * last.next_unsent);
}

std::size_t Flight::size_of(const Train& train, std::uint32_t chunk) const {
  return chunk_at(train.message, chunk).size();
}

std::optional<Flight::Part> Flight::next(HostTime now, std::size_t window_bytes) {
  find_lost(now);
  check_timeout(now);
  remove_exhausted();
  chosen_ = choose(window_bytes);
  if (!chosen_) return std::nullopt;
  Train& train = *find(chosen_->train);
  Part part{train.header, chunk_at(train.message, chosen_->chunk)};
  part.header.index = chosen_->chunk;
  part.header.attempt = train.chunks[chosen_->chunk].tries + 1;
  return part;
}

std::optional<Flight::Choice> Flight::choose(std::size_t window_bytes) {
  for (const Train& train : trains_) {
    for (std::uint32_t i = 0; i < train.next_unsent; ++i) {
      if (train.chunks[i].lost) return Choice{train.header.train, i};
    }
  }
  if (!has_unsent()) return std::nullopt;
  const Train& train = trains_.back();
  const std::size_t size = size_of(train, train.next_unsent);
  const bool full = bytes_on_the_way_ + size > window_bytes;
  if (full && (bytes_on_the_way_ > 0 || window_bytes == 0)) return std::nullopt;
  return Choice{train.header.train, train.next_unsent};
}

bool Flight::sent(HostTime now) {
  if (!chosen_) return false;
  Train* train = find(chosen_->train);
  const std::uint32_t index = std::exchange(chosen_, std::nullopt)->chunk;
  if (train == nullptr) return false;
  Chunk& chunk = train->chunks[index];
  if (chunk.tries > 0) ++resent_;
  if (chunk.tries == 0) chunk.first_sent_at = now;
  chunk.sent_at = now;
  chunk.order = ++sendings_;
  chunk.lost = false;
  ++chunk.tries;
  if (bytes_on_the_way_ == 0) progress_at_ = now;
  bytes_on_the_way_ += size_of(*train, index);
  if (index < train->next_unsent) return false;
  return ++train->next_unsent == train->header.count;
}

Flight::Train* Flight::find(std::uint32_t number) {
  const auto found = std::find_if(trains_.begin(), trains_.end(),
                                  [&](const Train& train) { return train.header.train == number; });
  return found == trains_.end() ? nullptr : &*found;
}

void Flight::came(Train& train, std::uint32_t index, HostTime now, News& news) {
  Chunk& chunk = train.chunks[index];
  if (chunk.came || chunk.tries == 0) return;
  if (!chunk.lost) bytes_on_the_way_ -= size_of(train, index);
  chunk.came = true;
  chunk.lost = false;
  // Of a repeated chunk it is not known here which one came (Karn); note_newest() may know.
  if (chunk.tries == 1 && chunk.order > newest_came_order_) {
    newest_came_order_ = chunk.order;
    newest_round_trip_ = now - chunk.sent_at;
  }
  ++news.chunks_came;
}

void Flight::lose(Train& train, std::uint32_t index) {
  train.chunks[index].lost = true;
  bytes_on_the_way_ -= size_of(train, index);
}

Flight::News Flight::on_ack(const Ack& ack, nanoseconds came_after, HostTime now) {
  News news;
  note_newest(ack, came_after, now, news);
  for (std::size_t i = 0; i < trains_.size();) {
    Train& train = trains_[i];
    const std::uint32_t number = train.header.train;
    const bool settled =
        number < ack.next_train || (number - ack.next_train < ReceivedTrains::kWindow &&
                                    (ack.received_bits >> (number - ack.next_train) & 1U) != 0);
    if (!settled || train.next_unsent == 0) {
      ++i;
      continue;
    }
    for (std::uint32_t c = 0; c < train.next_unsent; ++c) came(train, c, now, news);
    remove(i);
  }
  for (const PartialTrain& part : ack.partial) {
    Train* train = find(part.train);
    if (train == nullptr) continue;
    for (std::uint32_t c = 0; c < std::min(part.first_missing, train->next_unsent); ++c)
      came(*train, c, now, news);
    for (std::uint32_t bit = 0; bit < 64; ++bit) {
      const std::uint64_t c = std::uint64_t{part.first_missing} + bit;
      if (c < train->next_unsent && (part.came_bits >> bit & 1U) != 0) {
        came(*train, static_cast<std::uint32_t>(c), now, news);
      }
    }
  }
  if (news.chunks_came > 0) {
    progress_at_ = now;
    timeouts_in_a_row_ = 0;
  }
  find_lost(now);
  news.chunks_lost = std::exchange(lost_not_told_, 0);
  return news;
}

void Flight::note_newest(const Ack& ack, nanoseconds came_after, HostTime now, News& news) {
  const Train* train = find(ack.newest_train);
  if (train == nullptr || ack.newest_chunk >= train->next_unsent) return;
  const Chunk& chunk = train->chunks[ack.newest_chunk];
  const bool last = ack.newest_attempt == chunk.tries;
  if (!last && ack.newest_attempt != 1) return;  // one in between: when it was sent is forgotten
  const HostTime sent_at = last ? chunk.sent_at : chunk.first_sent_at;
  news.newest_sent = sent_at;
  news.round_trip = std::max(nanoseconds(0), now - sent_at - came_after);
  if (!chunk.came) learn_round_trip(*news.round_trip);
  if (last && chunk.order > newest_came_order_) {
    newest_came_order_ = chunk.order;
    newest_round_trip_ = now - sent_at;
  }
}

void Flight::learn_round_trip(nanoseconds sample) {
  if (!smooth_round_trip_) {
    smooth_round_trip_ = sample;
    round_trip_deviation_ = sample / 2;
    return;
  }
  const nanoseconds off =
      sample > *smooth_round_trip_ ? sample - *smooth_round_trip_ : *smooth_round_trip_ - sample;
  round_trip_deviation_ += (off - round_trip_deviation_) / 4;
  *smooth_round_trip_ += (sample - *smooth_round_trip_) / 8;
}

bool Flight::overtaken(const Chunk& chunk) const {
  return chunk.tries > 0 && !chunk.came && !chunk.lost && chunk.order < newest_came_order_;
}

HostTime Flight::lost_at(const Chunk& chunk) const {
  return chunk.sent_at + newest_round_trip_ + limits_.reordering;
}

void Flight::find_lost(HostTime now) {
  for (Train& train : trains_) {
    for (std::uint32_t i = 0; i < train.next_unsent; ++i) {
      if (!overtaken(train.chunks[i]) || now < lost_at(train.chunks[i])) continue;
      lose(train, i);
      ++lost_not_told_;
    }
  }
}

nanoseconds Flight::timeout() const {
  nanoseconds base = limits_.first_timeout;
  if (smooth_round_trip_) {
    base = 2 * *smooth_round_trip_ + 4 * round_trip_deviation_;
    base = std::max(base, timeouts_in_a_row_ == 0 ? limits_.first_least_timeout : limits_.least_timeout);
  }
  const int doublings = smooth_round_trip_ ? timeouts_in_a_row_ - 1 : timeouts_in_a_row_;
  for (int i = 0; i < doublings && base < limits_.most_timeout; ++i) base *= 2;
  return std::min(base, limits_.most_timeout);
}

std::optional<HostTime> Flight::silence_ends() const {
  if (bytes_on_the_way_ == 0 || !progress_at_) return std::nullopt;
  return *progress_at_ + timeout();
}

std::optional<HostTime> Flight::next_timeout() const {
  std::optional<HostTime> next = silence_ends();
  for (const Train& train : trains_) {
    for (std::uint32_t i = 0; i < train.next_unsent; ++i) {
      if (next && overtaken(train.chunks[i])) next = std::min(*next, lost_at(train.chunks[i]));
    }
  }
  return next;
}

void Flight::check_timeout(HostTime now) {
  const auto due = silence_ends();
  if (!due || now < *due) return;
  progress_at_ = now;
  ++timeouts_in_a_row_;
  for (Train& train : trains_) {  // the oldest only: its answer tells of the others
    for (std::uint32_t i = 0; i < train.next_unsent; ++i) {
      if (!train.chunks[i].came && !train.chunks[i].lost) return lose(train, i);
    }
  }
}

void Flight::remove_exhausted() {
  for (std::size_t i = 0; i < trains_.size();) {
    const auto& chunks = trains_[i].chunks;
    const bool exhausted = std::any_of(chunks.begin(), chunks.end(), [&](const Chunk& chunk) {
      return chunk.lost && chunk.tries >= limits_.tries;
    });
    if (!exhausted) {
      ++i;
      continue;
    }
    ++given_up_;
    remove(i);
  }
}

void Flight::remove(std::size_t index) {
  const Train& train = trains_[index];
  for (std::uint32_t i = 0; i < train.next_unsent; ++i) {
    if (!train.chunks[i].came && !train.chunks[i].lost) bytes_on_the_way_ -= size_of(train, i);
  }
  held_bytes_ -= train.message.size();
  trains_.erase(trains_.begin() + static_cast<std::ptrdiff_t>(index));
}

void Flight::start_over() {
  chosen_.reset();
  timeouts_in_a_row_ = 0;
  newest_came_order_ = 0;
  bytes_on_the_way_ = 0;
  for (Train& train : trains_) {
    for (std::uint32_t i = 0; i < train.next_unsent; ++i) {
      train.chunks[i] = {train.chunks[i].first_sent_at, HostTime{}, 0, 1, false, true};
    }
  }
}

}  // namespace edgesplat::link
