// SPDX-License-Identifier: Apache-2.0
#include "emulate/comparison.hpp"

#include <algorithm>
#include <optional>

namespace takt::emulate {
namespace {

using handshake::PublishedState;
using handshake::StateChange;

/// The `number`th time, from 0 on, that a participant makes a change.
struct Occasion {
  std::uint8_t participant = 0;
  StateChange change;
  std::size_t number = 0;
};

std::vector<StateChange> changes_of(const History& history, std::size_t participant) {
  std::vector<StateChange> changes;
  for (const Change& each : history.changes)
    if (each.participant == participant) changes.push_back(each.change);
  return changes;
}

std::optional<std::int64_t> time_of(const History& history, const Occasion& occasion) {
  std::size_t number = 0;
  for (const Change& each : history.changes)
    if (each.participant == occasion.participant && each.change == occasion.change && number++ == occasion.number)
      return each.time;
  return std::nullopt;
}

class Comparer {
 public:
  Comparer(const History& simulated, const History& emulated, const std::vector<std::string>& names)
      : simulated_(simulated), emulated_(emulated), names_(names) {}

  Comparison run() {
    for (std::size_t p = 0; p < names_.size(); ++p) {
      ParticipantComparison participant{names_[p], false, changes_of(simulated_, p), changes_of(emulated_, p)};
      participant.same = participant.simulated == participant.emulated;
      result_.participants.push_back(std::move(participant));
    }
    demand_barriers();
    for (const Call& call : simulated_.calls) demand_caller_first(call);
    return std::move(result_);
  }

 private:
  /// Slaves Ready, then the master, then slaves Running, then the master (paper, Fig. 3), at every start.
  void demand_barriers() {
    constexpr StateChange ready{1, PublishedState::HaltedInit, PublishedState::Ready};
    constexpr StateChange running{2, PublishedState::Ready, PublishedState::Running};
    for (std::size_t start = 0; time_of(simulated_, {0, ready, start}); ++start) {
      for (std::uint8_t slave = 1; slave < names_.size(); ++slave) {
        demand({slave, ready, start}, {0, ready, start});
        demand({0, ready, start}, {slave, running, start});
        demand({slave, running, start}, {0, running, start});
      }
    }
  }

  /// What a call changes at the participant that is called, the others change later.
  void demand_caller_first(const Call& call) {
    std::vector<Occasion> before;
    for (const Change& each : simulated_.changes) {
      if (each.participant != call.participant) continue;
      const auto number = static_cast<std::size_t>(
          std::count_if(before.begin(), before.end(), [&](const Occasion& o) { return o.change == each.change; }));
      before.push_back({each.participant, each.change, number});
      if (each.time != call.time) continue;
      for (std::uint8_t other = 0; other < names_.size(); ++other)
        if (other != call.participant) demand(before.back(), {other, each.change, number});
    }
  }

  void demand(const Occasion& first, const Occasion& second) {
    const auto simulated_first = time_of(simulated_, first);
    const auto simulated_second = time_of(simulated_, second);
    if (!simulated_first || !simulated_second || *simulated_first >= *simulated_second) return;
    ++result_.orders;
    const auto emulated_first = time_of(emulated_, first);
    const auto emulated_second = time_of(emulated_, second);
    if (!emulated_first || !emulated_second) return;  // the participants' own orders say so
    if (*emulated_first < *emulated_second) return;
    result_.violated.push_back(text_of(second) + " before " + text_of(first));
  }

  std::string text_of(const Occasion& occasion) const {
    return names_[occasion.participant] + " " + std::string(name_of(occasion.change.to)) + " (" +
           std::to_string(occasion.number + 1) + ")";
  }

  const History& simulated_;
  const History& emulated_;
  const std::vector<std::string>& names_;
  Comparison result_;
};

}  // namespace

bool Comparison::is_same() const {
  return violated.empty() && std::all_of(participants.begin(), participants.end(),
                                         [](const ParticipantComparison& each) { return each.same; });
}

Comparison compare(const History& simulated, const History& emulated, const std::vector<std::string>& names) {
  return Comparer(simulated, emulated, names).run();
}

}  // namespace takt::emulate
