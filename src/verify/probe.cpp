#include "verify/probe.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <thread>

#include "results/evaluate.hpp"
#include "scenario/resolve/resolve.hpp"
#include "scenario/run/run.hpp"

namespace takt::verify {

std::optional<Probe> probe(const scenario::Scenario& scenario, const std::function<bool()>& interrupted) {
  scenario::json::Diagnostics diagnostics;
  const auto resolved = scenario::resolve(scenario, diagnostics);
  if (!resolved) return std::nullopt;
  scenario::Run run(*resolved);
  constexpr std::uint64_t events_a_slice = 500'000;
  while (!run.advance(events_a_slice))
    if (interrupted && interrupted()) return std::nullopt;
  return Probe{results::evaluate(run, false).requirements, run.simulation().event_count(), run.simulation().digest().value()};
}

std::vector<std::optional<Probe>> probe_all(std::span<const scenario::Scenario> scenarios, unsigned jobs, const std::function<bool()>& interrupted) {
  std::vector<std::optional<Probe>> probes(scenarios.size());
  std::vector<std::exception_ptr> failures(scenarios.size());
  std::atomic<std::size_t> next = 0;
  const auto work = [&] {
    for (std::size_t i = next++; i < scenarios.size(); i = next++) {
      try {
        probes[i] = probe(scenarios[i], interrupted);
      } catch (...) {
        failures[i] = std::current_exception();
      }
    }
  };
  std::vector<std::thread> threads;
  for (unsigned t = 1; t < std::min<std::size_t>(jobs, scenarios.size()); ++t) threads.emplace_back(work);
  work();
  for (std::thread& thread : threads) thread.join();
  for (const std::exception_ptr& failure : failures)
    if (failure) std::rethrow_exception(failure);
  return probes;
}

}  // namespace takt::verify
