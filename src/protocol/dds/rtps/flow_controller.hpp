// SPDX-License-Identifier: Apache-2.0
// FlowController: sends the samples of asynchronous writers, so many octets in a period, in the order of its scheduler
// (as Fast DDS does).
#pragma once

#include <deque>
#include <string>

#include "dds/rtps/stateful_writer.hpp"

namespace takt::dds {

enum class FlowScheduler : std::uint8_t {
  fifo,                       ///< samples in the order of writing
  round_robin,                ///< one sample of each writer in turn
  high_priority,              ///< the writer with the lowest number, then as fifo
  priority_with_reservation,  ///< first writers that have not used up their reservation, then all, both by priority
};

struct FlowControllerSettings {
  std::string name;
  FlowScheduler scheduler = FlowScheduler::fifo;
  std::uint32_t max_bytes_per_period =
      0;  ///< octets of RTPS messages with data or fragments, a HEARTBEAT with them included; 0: no limit
  sim::Duration period = sim::Duration::from_ps(100'000'000'000);  ///< 100 ms; above 0
  static constexpr std::uint32_t least_bytes_per_period = 256;     ///< below, not even a small fragment fits
};

/// What a writer has of its controller.
struct FlowShare {
  std::int32_t priority = 10;     ///< -10 (highest) to 10
  std::uint32_t reservation = 0;  ///< percent of max_bytes_per_period, 0 to 100
};

/// Contradictions of the settings, or "".
std::string problem_of(const FlowControllerSettings& settings);

class FlowController {
 public:
  /// Periods begin at `now`.
  FlowController(const FlowControllerSettings& settings, sim::LocalTime now);

  const FlowControllerSettings& settings() const { return settings_; }
  /// Writers have their place in the order of being added.
  void add(StatefulWriter& writer, const FlowShare& share);
  void remove(const StatefulWriter& writer);
  /// The writer has something to send: a new sample, or one that is asked for again.
  void notify(const StatefulWriter& writer, sim::LocalTime now);

  sim::LocalTime next_wake() const { return ready_at_; }
  void wake(sim::LocalTime now, Outbox& outbox);

 private:
  struct Place {
    StatefulWriter* writer = nullptr;
    FlowShare share;
    std::uint64_t used = 0;                                        ///< octets in this period
    std::deque<std::pair<std::uint64_t, SequenceNumber>> waiting;  ///< when it came (a count), and what
    bool operator==(const StatefulWriter* other) const { return writer == other; }
  };

  void begin_period(sim::LocalTime now);
  /// The next to send, and the size of its message; nullptr: nobody.
  Place* choose(Outbox& outbox, std::size_t& size);
  bool is_reserved(const Place& place, std::size_t size) const;

  FlowControllerSettings settings_;
  sim::LocalTime period_begin_;
  std::uint64_t used_ = 0;
  std::vector<Place> places_;
  std::size_t turn_ = 0;  ///< round robin: whose sample is at hand
  std::uint64_t arrivals_ = 0;
  sim::LocalTime ready_at_ = sim::LocalTime::never();
};

}  // namespace takt::dds
