#include "verify/probe.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <thread>

#include "evaluation/evaluate.hpp"
#include "scenario/resolve/resolve.hpp"
#include "scenario/run/run.hpp"

namespace takt::verify {

std::optional<Probe> probe(const scenario::Scenario& scenario, const analysis::Bounds& bounds, const std::function<bool()>& interrupted) {
  json::Diagnostics diagnostics;
  const auto resolved = scenario::resolve(scenario, diagnostics);
  if (!resolved) return std::nullopt;
  scenario::Run run(*resolved);
  constexpr std::uint64_t events_a_slice = 500'000;
  while (!run.advance(events_a_slice))
    if (interrupted && interrupted()) return std::nullopt;
  results::RunResult result = evaluation::evaluate(run, false);
  std::vector<Violation> violations = violations_in(run, result);
  std::string contradiction = contradiction_in(*resolved, bounds, result);
  return Probe{std::move(result.requirements), run.simulation().event_count(), run.simulation().digest().value(), std::move(violations), std::move(contradiction)};
}

std::vector<std::optional<Probe>> probe_all(std::span<const scenario::Scenario> scenarios, const analysis::Bounds& bounds, unsigned jobs, const std::function<bool()>& interrupted) {
  std::vector<std::optional<Probe>> probes(scenarios.size());
  std::vector<std::exception_ptr> failures(scenarios.size());
  std::atomic<std::size_t> next = 0;
  const auto work = [&] {
    for (std::size_t i = next++; i < scenarios.size(); i = next++) {
      try {
        probes[i] = probe(scenarios[i], bounds, interrupted);
      } catch (...) {
        failures[i] = std::current_exception();
      }
    }
  };
  {
    std::vector<std::jthread> threads;  // joined also where the machine gives no further one
    for (unsigned t = 1; t < std::min<std::size_t>(jobs, scenarios.size()); ++t) threads.emplace_back(work);
    work();
  }
  for (const std::exception_ptr& failure : failures)
    if (failure) std::rethrow_exception(failure);
  return probes;
}

}  // namespace takt::verify
