// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/time/time.hpp"
#include "test/support/random.hpp"

#include <cstddef>
#include <map>
#include <vector>

namespace edgesplat::test {

/// What a network may do to samples, one after the other, by chance.
struct Faults {
  double loss = 0.0;
  double duplicates = 0.0;
  double flipped_bits = 0.0;  ///< samples with one
  double least_delay_s = 0.01;
  double most_delay_s = 0.06;  ///< samples overtake each other
};

/// One direction of a network in virtual time. Seeded, hence repeatable.
class FaultyWay {
 public:
  using Bytes = std::vector<std::byte>;
  FaultyWay(const Faults& faults, std::uint64_t seed) : faults_(faults), random_(seed) {}

  void set_faults(const Faults& faults) { faults_ = faults; }
  void send(const Bytes& sample, HostTime now) {
    const int copies = random_.uniform() < faults_.duplicates ? 2 : 1;
    for (int i = 0; i < copies; ++i) {
      if (random_.uniform() < faults_.loss) continue;
      Bytes copy = sample;
      if (random_.uniform() < faults_.flipped_bits) {
        copy[random_.below(copy.size())] ^= std::byte{1} << random_.below(8);
        ++flipped_;
      }
      const double delay_s = random_.uniform(faults_.least_delay_s, faults_.most_delay_s);
      under_way_.emplace(now + from_seconds(delay_s), std::move(copy));
    }
  }
  /// What has arrived by `now`, in the order of arrival.
  std::vector<Bytes> arrived(HostTime now) {
    std::vector<Bytes> samples;
    while (!under_way_.empty() && under_way_.begin()->first <= now) {
      samples.push_back(std::move(under_way_.begin()->second));
      under_way_.erase(under_way_.begin());
    }
    return samples;
  }
  [[nodiscard]] std::size_t flipped() const { return flipped_; }

 private:
  Faults faults_;
  Random random_;
  std::multimap<HostTime, Bytes> under_way_;
  std::size_t flipped_ = 0;
};

}  // namespace edgesplat::test
