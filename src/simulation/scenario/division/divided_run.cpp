// SPDX-License-Identifier: Apache-2.0
#include "scenario/division/divided_run.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <map>
#include <thread>
#include <utility>

namespace takt::scenario {

/// The exchange is there before the network that sends by it, and knows the network afterwards.
struct DividedRun::PartOfRun final : models::FrameExchange {
  PartOfRun(const Resolved& resolved, const Division& division, std::uint32_t number, std::uint64_t tie_shuffle)
      : run(resolved, tie_shuffle, {division.part_of_node, number, this}),
        part(run.simulation(), run.network(), division.parts, division.parts > std::thread::hardware_concurrency()) {}
  void send(std::uint32_t to, const sim::Event& arrival, models::FrameIndex frame) override {
    part.send(to, arrival, frame);
  }

  Run run;
  models::Part part;
};

namespace {

/// Calls work(part) for each part, on a thread each. What one of them throws, or that there is no further thread, comes
/// out here; give_up() is called at once then.
template <class Work, class GiveUp>
void on_threads(std::size_t parts, Work&& work, GiveUp&& give_up) {
  std::vector<std::exception_ptr> thrown(parts);
  const auto guarded = [&](std::size_t part, auto&& what) {
    try {
      what();
    } catch (...) {
      thrown[part] = std::current_exception();
      give_up();
    }
  };
  {
    std::vector<std::jthread> others;  // joined also where the machine gives no further one
    guarded(0, [&] {
      for (std::size_t part = 1; part < parts; ++part)
        others.emplace_back([&, part] { guarded(part, [&] { work(part); }); });
      work(0);
    });
  }
  for (const std::exception_ptr& each : thrown)
    if (each) std::rethrow_exception(each);
}

}  // namespace

DividedRun::DividedRun(const Resolved& resolved, const Division& division, std::uint64_t tie_shuffle)
    : parts_(division.parts) {
  on_threads(
      division.parts,
      [&](std::size_t p) {
        parts_[p] = std::make_unique<PartOfRun>(resolved, division, static_cast<std::uint32_t>(p), tie_shuffle);
      },
      [] {});
  std::map<std::pair<std::uint32_t, std::uint32_t>, models::Mailbox*> between;
  for (const Boundary& boundary : division.boundaries) {
    mailboxes_.push_back(std::make_unique<models::Mailbox>());
    between[{boundary.from, boundary.to}] = mailboxes_.back().get();
  }
  for (const Boundary& boundary : division.boundaries)
    parts_[boundary.from]->part.add_neighbour({boundary.to, boundary.promise, between.at({boundary.from, boundary.to}),
                                               between.at({boundary.to, boundary.from}),
                                               &parts_[boundary.to]->part.bell()});
}

DividedRun::~DividedRun() = default;

sim::TrueTime DividedRun::end() const { return parts_.front()->run.end(); }

std::uint64_t DividedRun::event_count() const {
  std::uint64_t sum = 0;
  for (const auto& each : parts_) sum += each->run.simulation().event_count();
  return sum;
}

std::vector<Run*> DividedRun::runs() {
  std::vector<Run*> runs;
  for (const auto& each : parts_) runs.push_back(&each->run);
  return runs;
}

void DividedRun::watch(std::size_t part, models::CrossingWatcher* watcher) { parts_[part]->part.set_watcher(watcher); }

void DividedRun::advance(sim::TrueTime until) {
  until = std::min(until, end());
  std::atomic<bool> stop = false;
  // Without one of them the others would wait for ever.
  const auto give_up = [&] {
    stop.store(true);
    for (const auto& each : parts_) each->part.bell().ring();
  };
  on_threads(
      parts_.size(), [&](std::size_t p) { parts_[p]->part.advance(until, stop); }, give_up);
  now_ = until;
}

const Run& DividedRun::gathered() {
  if (!is_gathered_) {
    for (const auto& each : parts_) each->part.receive_posted();
    std::vector<const Run*> others;
    for (std::size_t p = 1; p < parts_.size(); ++p) others.push_back(&parts_[p]->run);
    parts_[0]->run.adopt(others);
    is_gathered_ = true;
  }
  return parts_[0]->run;
}

}  // namespace takt::scenario
