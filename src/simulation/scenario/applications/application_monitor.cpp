// SPDX-License-Identifier: Apache-2.0
#include "scenario/applications/application_monitor.hpp"

#include "models/ethernet/traffic.hpp"

namespace takt::scenario {
namespace {
// Kinds of digest records, apart from those of the network (models::Occurrence) and of Programs.
constexpr std::uint32_t called = 140;
constexpr std::uint32_t values_taken = 141;
constexpr std::uint32_t signal_set = 142;
constexpr std::uint32_t application_crashed = 143;
}  // namespace

ApplicationMonitor::ApplicationMonitor(sim::Simulation& simulation, const std::vector<ResolvedSignal>& signals,
                                       std::span<const sim::Duration> instants)
    : simulation_(&simulation) {
  for (const ResolvedSignal& signal : signals) signals_.emplace_back(signal.pulse, instants);
}

void ApplicationMonitor::on_call(std::uint32_t application, std::uint32_t thread, std::uint64_t number) {
  simulation_->digest().add(called, who(application, thread), simulation_->now(), number);
}

void ApplicationMonitor::on_values(std::uint32_t application, std::uint32_t thread, std::uint64_t count) {
  simulation_->digest().add(values_taken, who(application, thread), simulation_->now(), count);
}

void ApplicationMonitor::on_crash(std::uint32_t application) {
  simulation_->digest().add(application_crashed, who(application, 0), simulation_->now(), 0);
}

void ApplicationMonitor::set_signal(std::uint32_t signal, bool high, sim::Duration latency) {
  if (!signals_[signal].set(high, simulation_->now(), latency)) return;
  simulation_->digest().add(signal_set, signal, simulation_->now(), high ? 1 : 0);
  if (sim::TraceSink* const trace = simulation_->trace())
    trace->record({simulation_->now(),
                   static_cast<std::uint32_t>(models::Occurrence::output_changed),
                   {},
                   signal,
                   high ? std::uint64_t{1} : std::uint64_t{0}});
}

}  // namespace takt::scenario
