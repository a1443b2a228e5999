// SPDX-License-Identifier: Apache-2.0
// A component that writes down what reaches it.
#pragma once

#include <functional>
#include <vector>

#include "sim/simulation.hpp"

namespace takt::sim::test {

constexpr TrueTime at_ps(std::int64_t ps) { return TrueTime::from_ps(ps); }

/// One line of the log: an event, or (decided) that the instant of `time` is over for the node.
struct Entry {
  std::int64_t time = 0;
  std::uint32_t who = 0;
  EventKind kind = 0;
  std::uint64_t argument = 0;
  bool decided = false;
  bool operator==(const Entry&) const = default;
};

/// Logs each event and each decision; `on_event` and `on_decide` may do more. Several may share one log.
class Recorder final : public Component {
 public:
  Recorder(Simulation& simulation, std::vector<Entry>& log) : source(simulation.add(*this)), log_(&log) {}

  void handle(Simulation& simulation, const Event& event) override {
    if (event.kind() == Simulation::decide_now) {
      simulation.uncount_event();
      simulation.decide_later(id(), Decision::egress);
      return;
    }
    log_->push_back({event.time.ps(), source.id().index, event.kind(), event.argument, false});
    if (on_event) on_event(simulation, event);
  }
  void decide(Simulation& simulation) override {
    log_->push_back({simulation.now().ps(), source.id().index, 0, 0, true});
    if (on_decide) on_decide(simulation);
  }
  ComponentId id() const { return source.id(); }

  EventSource source;
  std::function<void(Simulation&, const Event&)> on_event;
  std::function<void(Simulation&)> on_decide;

 private:
  std::vector<Entry>* log_;
};

}  // namespace takt::sim::test
