// SPDX-License-Identifier: Apache-2.0
// How long it takes from publishing process data to receiving the reply. It sees both ends and true time, no
// participant asks it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scenario/figures/accounts.hpp"
#include "scenario/resolved/resolved.hpp"
#include "sim/histogram.hpp"

namespace takt::scenario {

class RoundTrips {
 public:
  /// Figures are kept from each of the instants on: of requests that were published then or later.
  RoundTrips(const ResolvedProgram& program, std::span<const sim::Duration> instants);

  /// A message of process data is handed to the operating system.
  void on_published(std::uint8_t data_set, std::uint16_t sequence, sim::TrueTime now);
  /// Message `sequence` of reply `reply` answers message `request` of the data set that it answers.
  void on_replied(std::size_t reply, std::uint16_t sequence, std::uint16_t request, sim::TrueTime now);
  /// A message of process data has reached an application.
  void on_received(std::uint8_t data_set, std::uint16_t sequence, std::size_t to, sim::TrueTime now);

  std::size_t count() const { return replies_.size(); }
  struct Times {
    sim::Histogram round_trips;  ///< from publishing to receiving the reply
    sim::Histogram one_way;      ///< from publishing to the end of the work at it, when the reply is published
  };
  const Times& times(std::size_t reply, sim::Duration from) const { return replies_[reply].times.from(from); }

 private:
  // Messages are remembered for this many of their kind; nobody waits longer for an answer.
  static constexpr std::size_t memory = 1024;
  struct Sent {
    sim::TrueTime time = sim::TrueTime::never();
    std::uint16_t sequence = 0;
  };
  struct One {
    explicit One(std::span<const sim::Duration> instants) : times(instants) {}
    std::uint8_t request = 0;
    std::uint8_t with = 0;
    std::size_t asker = 0;
    std::vector<Sent> requests;  // as they were published
    std::vector<Sent> answered;  // by number of the reply: when its request was published
    Accounts<Times> times;
  };
  std::vector<One> replies_;
};

}  // namespace takt::scenario
