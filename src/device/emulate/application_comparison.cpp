// SPDX-License-Identifier: Apache-2.0
#include "emulate/application_comparison.hpp"

#include <algorithm>

#include "json/document.hpp"

namespace takt::emulate {
namespace {

using namespace sim::literals;  // NOLINT: units

constexpr std::uint64_t many_edges = 10;        // so many that those of a real node are no matter of luck
constexpr sim::Duration not_together = 100_ms;  // nodes begin and end so far apart

std::uint64_t counted_in(const json::Node& node, const char* key) {
  const json::Node* const found = node.find(key);
  return found == nullptr ? 0 : static_cast<std::uint64_t>(json::double_of(*found));
}

std::string text_in(const json::Node& node, const char* key) {
  const json::Node* const found = node.find(key);
  return found == nullptr ? std::string() : found->text;
}

std::int64_t integer_in(const json::Node& node, const char* key) {
  const json::Node* const found = node.find(key);
  return found == nullptr ? 0 : static_cast<std::int64_t>(json::double_of(*found));
}

Times times_in(const json::Node& node, const char* key) {
  const json::Node* const found = node.find(key);
  if (found == nullptr) return {};
  return {counted_in(*found, "count"), integer_in(*found, "min_ns"), integer_in(*found, "mean_ns"),
          integer_in(*found, "max_ns")};
}

std::optional<SignalCounts> signal_in(const json::Node& thread) {
  const json::Node* const found = thread.find("signal");
  if (found == nullptr) return std::nullopt;
  return SignalCounts{counted_in(*found, "edges"), counted_in(*found, "irregular_pulses"), times_in(*found, "latency"),
                      times_in(*found, "pulses")};
}

Times times_of(const application::DurationFigures& figures) {
  if (figures.count() == 0) return {};
  return {figures.count(), figures.least().ps() / 1000, figures.mean().ps() / 1000, figures.greatest().ps() / 1000};
}

SignalCounts signal_of(const scenario::DigitalOutput::Figures& figures) {
  return {figures.latency.count(), figures.irregular_pulses, times_of(figures.latency), times_of(figures.pulses)};
}

class ThreadComparer {
 public:
  ThreadComparer(const scenario::Resolved& resolved, const std::vector<std::vector<ThreadCounts>>& simulated,
                 const EmulatedThreads& emulated, const std::vector<bool>& is_whole)
      : r_(resolved), simulated_(simulated), emulated_(emulated), is_whole_(is_whole) {}

  ApplicationComparison compare(std::uint32_t a) const {
    const scenario::ResolvedApplication& application = r_.applications[a];
    ApplicationComparison made{application.name, r_.topology.nodes[application.node.value].name, is_whole_[a], {}};
    for (std::uint32_t t = 0; t < application.threads.size(); ++t) {
      const scenario::ResolvedThread& thread = application.threads[t];
      made.threads.push_back({thread.name,
                              r_.topics[thread.topic].description->name,
                              thread.publishes,
                              simulated_[a][t],
                              emulated(a, t),
                              {}});
      judge(a, thread, made.threads.back());
    }
    return made;
  }

 private:
  ThreadCounts emulated(std::uint32_t a, std::uint32_t t) const {
    const auto found = emulated_.find({r_.applications[a].name, r_.applications[a].threads[t].name});
    return found == emulated_.end() ? ThreadCounts() : found->second;
  }

  void judge(std::uint32_t a, const scenario::ResolvedThread& thread, ThreadComparison& made) const {
    const auto differ = [&made](std::string what) { made.differs.push_back(std::move(what)); };
    const auto at_all = [&](std::uint64_t simulated, std::uint64_t emulated, const char* what) {
      if ((simulated == 0) != (emulated == 0))
        differ(std::string(emulated == 0 ? "no " : "") + what + (emulated == 0 ? "" : ", simulated none"));
    };
    if (!is_whole_[a]) return;  // what it did before it was killed is not known
    at_all(made.simulated.activations, made.emulated.activations, "activations");
    const auto [less, more] = std::minmax(made.simulated.activations, made.emulated.activations);
    const std::uint64_t apart = std::max(more / 4, static_cast<std::uint64_t>(not_together / thread.every + 2));
    if (less != 0 && more - less > apart)
      differ(std::to_string(made.emulated.activations) + " activations, simulated " +
             std::to_string(made.simulated.activations));
    if (thread.publishes) at_all(made.simulated.published, made.emulated.published, "values published");
    if (thread.signal && made.emulated.signal && made.emulated.signal->edges > made.emulated.received)
      differ(std::to_string(made.emulated.signal->edges) + " edges, of " + std::to_string(made.emulated.received) +
             " values received");
    if (thread.publishes || !hears_whole_ones(thread)) return;
    if (thread.signal && made.simulated.signal && made.simulated.signal->edges >= many_edges &&
        (!made.emulated.signal || made.emulated.signal->edges == 0))
      differ("no edges, simulated " + std::to_string(made.simulated.signal->edges));
    at_all(made.simulated.received, made.emulated.received, "values received");
    std::uint64_t sent = 0;
    for (const scenario::ResolvedInput& input : thread.inputs)
      sent += emulated(input.application, input.thread).published;
    if (made.emulated.received > sent)
      differ(std::to_string(made.emulated.received) + " values received, of " + std::to_string(sent) +
             " that were published");
  }

  bool hears_whole_ones(const scenario::ResolvedThread& thread) const {
    return std::ranges::all_of(thread.inputs,
                               [&](const scenario::ResolvedInput& input) { return is_whole_[input.application]; });
  }

  const scenario::Resolved& r_;
  const std::vector<std::vector<ThreadCounts>>& simulated_;
  const EmulatedThreads& emulated_;
  const std::vector<bool>& is_whole_;
};

}  // namespace

bool ApplicationComparison::is_same() const { return std::ranges::all_of(threads, &ThreadComparison::is_same); }

std::vector<std::vector<ThreadCounts>> threads_of(const scenario::Run& run) {
  std::vector<std::vector<ThreadCounts>> all;
  for (std::size_t a = 0; a < run.resolved().applications.size(); ++a) {
    std::vector<ThreadCounts>& threads = all.emplace_back();
    for (std::size_t t = 0; t < run.resolved().applications[a].threads.size(); ++t) {
      const scenario::ThreadFigures figures = run.thread(a, t, sim::Duration());
      const auto signal = run.resolved().applications[a].threads[t].signal;
      threads.push_back(
          {figures.activations, figures.activations - figures.done, figures.published, figures.arrived, figures.lost,
           times_of(figures.response),
           signal ? std::optional(signal_of(run.signal(*signal).figures(sim::Duration()))) : std::nullopt});
    }
  }
  return all;
}

bool add_threads(const std::string& line, EmulatedThreads& threads) {
  json::Diagnostics diagnostics;
  const auto document = json::parse(line, "statistics", diagnostics);
  if (!document || text_in(document->root(), "event") != "end") return false;
  for (const char* kind : {"applications", "gateways"}) {
    const json::Node* const all = document->root().find(kind);
    if (all == nullptr) continue;
    for (const json::Node& application : all->items) {
      const json::Node* const each_thread = application.find("threads");
      if (each_thread == nullptr) return false;
      for (const json::Node& thread : each_thread->items) {
        ThreadCounts counts;
        counts.missed = counted_in(thread, "missed");
        counts.activations = counted_in(thread, "calls") + counts.missed;
        counts.published = counted_in(thread, "sent");
        counts.received = counted_in(thread, "taken");
        counts.lost = counted_in(thread, "lost");
        counts.response = times_in(thread, "response");
        counts.signal = signal_in(thread);
        threads[{text_in(application, "name"), text_in(thread, "name")}] = counts;
      }
    }
  }
  return true;
}

std::vector<ApplicationComparison> compare_applications(const scenario::Resolved& resolved,
                                                        const std::vector<std::vector<ThreadCounts>>& simulated,
                                                        const EmulatedThreads& emulated,
                                                        const std::vector<bool>& is_whole) {
  const ThreadComparer comparer(resolved, simulated, emulated, is_whole);
  std::vector<ApplicationComparison> all;
  for (std::uint32_t a = 0; a < resolved.applications.size(); ++a)
    if (!resolved.applications[a].service) all.push_back(comparer.compare(a));
  return all;
}

}  // namespace takt::emulate
