// SPDX-License-Identifier: Apache-2.0
// What an observer remembers of one participant of a group: its own part of handshake::RunHistory, by the same rules.
// S1 and S2 ask for the parts of all others; whoever keeps these together asks them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "explore/model/hash_index.hpp"
#include "explore/properties/small_observer.hpp"
#include "sim/check.hpp"

namespace takt::explore {

class Seen {
 public:
  /// What a step has to be judged by.
  struct Step {
    std::uint32_t running_in = 0;  ///< it has become Running in this run; 0: it has not
    bool without_init = false;     ///< without INIT before: S4
  };

  Step take(const Effect& effect) {
    Step step;
    for (const handshake::StateChange& change : effect.changes()) {
      if (change.to == handshake::PublishedState::Halted) passed_init_ = false;
      if (change.to == handshake::PublishedState::HaltedInit) passed_init_ = true;
      if (change.to == handshake::PublishedState::Ready) run(effect.run).ready = true;
      if (change.to != handshake::PublishedState::Running) continue;
      run(effect.run).running = true;
      step.running_in = effect.run;
      step.without_init = step.without_init || !passed_init_;
    }
    if (effect.joins) run(effect.run).ready = true;
    return step;
  }
  void restart() { passed_init_ = false; }

  /// At any time in this run.
  bool was_ready(std::uint32_t run) const {
    for (std::size_t i = 0; i < size_; ++i)
      if (runs_[i].id == run) return runs_[i].ready;
    return false;
  }
  bool was_running(std::uint32_t run) const {
    for (std::size_t i = 0; i < size_; ++i)
      if (runs_[i].id == run) return runs_[i].running;
    return false;
  }

  bool operator==(const Seen&) const = default;
  std::uint64_t hash() const {
    std::uint64_t digest = mixed(passed_init_);
    for (std::size_t i = 0; i < size_; ++i)
      digest = mixed(digest ^ (std::uint64_t{runs_[i].id} << 2 | std::uint64_t{runs_[i].ready} << 1 |
                               std::uint64_t{runs_[i].running}));
    return digest;
  }

 private:
  struct Run {
    std::uint32_t id = 0;
    bool ready = false;
    bool running = false;
    bool operator==(const Run&) const = default;
  };
  /// In rising order, so that equal knowledge is equal.
  Run& run(std::uint32_t id) {
    std::size_t at = 0;
    while (at < size_ && runs_[at].id < id) ++at;
    if (at < size_ && runs_[at].id == id) return runs_[at];
    TAKT_CHECK(size_ < runs_.size(), "the runs of an exploration are few: a start costs a call");
    for (std::size_t i = size_; i > at; --i) runs_[i] = runs_[i - 1];
    runs_[at] = {id, false, false};
    ++size_;
    return runs_[at];
  }

  bool passed_init_ = false;  ///< since it was last Halted
  std::uint8_t size_ = 0;
  std::array<Run, 20> runs_{};
};

struct HashOfSeen {
  std::size_t operator()(const Seen& seen) const { return seen.hash(); }
};

}  // namespace takt::explore
