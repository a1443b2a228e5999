// SPDX-License-Identifier: Apache-2.0
// One run on several threads: the same events at the same times, the same digest and result for every division.
#pragma once

#include <memory>
#include <vector>

#include "models/parts/part.hpp"
#include "scenario/division/division.hpp"
#include "scenario/run/run.hpp"

namespace takt::scenario {

class DividedRun {
 public:
  /// Each part is a network of its own, built from the whole scenario, in which only the part's nodes act. `resolved`
  /// and `division` outlive the run.
  DividedRun(const Resolved& resolved, const Division& division, std::uint64_t tie_shuffle = 0);
  ~DividedRun();
  DividedRun(const DividedRun&) = delete;
  DividedRun& operator=(const DividedRun&) = delete;

  sim::TrueTime now() const { return now_; }
  sim::TrueTime end() const;
  std::uint64_t event_count() const;

  // For who records the run: before anything has happened.
  /// The parts, in their order. Programs and applications act in the first one.
  std::vector<Run*> runs();
  /// Tells who follows frames over the cuts what that part sends and takes, on its thread; null: nobody.
  void watch(std::size_t part, models::CrossingWatcher* watcher);

  /// All parts go on until `until`, on a thread each. What one of them throws comes out here; the run is over then.
  void advance(sim::TrueTime until);

  /// What has happened, as one run; advance() must not be called any more.
  const Run& gathered();

 private:
  struct PartOfRun;
  std::vector<std::unique_ptr<PartOfRun>> parts_;
  std::vector<std::unique_ptr<models::Mailbox>> mailboxes_;
  sim::TrueTime now_;
  bool is_gathered_ = false;
};

}  // namespace takt::scenario
