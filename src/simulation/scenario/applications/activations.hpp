// SPDX-License-Identifier: Apache-2.0
// When a thread acts: absolute deadlines on its host's clock, a response time after each, and what is missed.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "application/activation_grid.hpp"
#include "application/activation_plan.hpp"
#include "scenario/figures/accounts.hpp"
#include "sim/distribution.hpp"
#include "sim/random.hpp"
#include "sim/time.hpp"

namespace takt::scenario {

/// Activation n is due at offset + n * every, and answered as the plan says.
class Activations {
 public:
  /// `path` names the thread in the random streams, e.g. "robot/control/publish". The distribution outlives it. Counts
  /// are kept from each of the instants on, of the activations that are due then or later.
  Activations(sim::Duration every, sim::Duration offset, const sim::Distribution& response, std::uint64_t seed,
              std::string_view path, std::span<const sim::Duration> instants);

  /// The thread begins, or its clock has jumped: the first activation is that which is due next.
  void begin(sim::LocalTime now);
  /// It is gone; what was decided so far counts.
  void end(sim::LocalTime now);

  /// When it acts next; never if it has not begun.
  sim::LocalTime next() const { return next_; }
  /// A call whose time has come.
  struct Call {
    std::int64_t activation = 0;
    sim::Duration response;  ///< drawn: after it the thread is ready
  };
  /// Its time has come: the call that begins, if one does. Plans on.
  std::optional<Call> act();
  /// The call takes place now.
  void finish(const Call& call);
  /// What a processor was busy with until now: the response time since the call's activation was due, or none if it is
  /// missed.
  std::optional<sim::Duration> response_at(const Call& call, sim::LocalTime now) const;
  /// The clock is far beyond the time that was planned: it was set.
  bool has_jumped(sim::LocalTime now) const { return now - next_ >= every_; }

  /// In all.
  std::uint64_t done() const { return done_; }
  /// When the activation was due whose call took place last.
  sim::LocalTime last_due() const { return due(last_done_); }
  /// Of those due at the instant or later.
  std::uint64_t done(sim::Duration from) const { return counts_.from(from).done; }
  /// Activations of which it is known by then whether they were done; the others were missed.
  std::uint64_t decided(sim::LocalTime now, sim::Duration from) const;

 private:
  sim::LocalTime due(std::int64_t activation) const { return sim::LocalTime::from_ps(grid_.due(activation)); }
  std::int64_t latest_at(sim::LocalTime now) const { return grid_.latest_at(now.ps()); }
  void plan();

  sim::Duration every_;
  application::ActivationGrid grid_;  // ps
  application::ActivationPlan plan_;
  std::int64_t first_ = 0;      // activation since the last begin
  std::int64_t last_done_ = 0;  // below first_: none
  sim::LocalTime next_ = sim::LocalTime::never();
  std::uint64_t done_ = 0;
  struct Counts {
    std::optional<sim::LocalTime> from;  // none: all
    std::uint64_t done = 0;
    std::uint64_t decided_before = 0;  // the last begin
  };
  std::uint64_t decided(sim::LocalTime now, const Counts& counts) const;
  Accounts<Counts, sim::LocalTime> counts_;
};

}  // namespace takt::scenario
