// SPDX-License-Identifier: Apache-2.0
#include "verify/probe.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <thread>

#include "evaluation/evaluate.hpp"
#include "scenario/resolve.hpp"
#include "scenario/run/run.hpp"

namespace takt::verify {
namespace {

std::string reactions_of(const results::RunResult& result) {
  std::string text;
  for (const results::ProgramResult& program : result.programs)
    for (const auto* const list : {&program.reactions, &program.tree_reactions})
      for (const results::ReactionResult& each : *list)
        text += program.name + ' ' + each.initiator + ' ' + each.kind + ' ' + each.cause +
                (each.superseded  ? " superseded"
                 : each.completed ? ""
                                  : " open") +
                '\n';
  return text;
}

std::vector<std::uint64_t> violations_of(const results::RunResult& result) {
  std::vector<std::uint64_t> broken(result.requirements.size(), 0);
  for (std::size_t i = 0; i < broken.size(); ++i) {
    if (result.requirements[i].kind != results::RequirementKind::invariants) continue;
    const auto program =
        std::ranges::find(result.programs, result.requirements[i].subject, &results::ProgramResult::name);
    if (program != result.programs.end()) broken[i] = program->violations.size();
  }
  return broken;
}

}  // namespace

namespace {

/// A run above a bound that rests on a promise of a data sheet shows that the promise is not kept: clocks are further
/// apart in this run, or what was sent before they were so near is still in the way.
bool is_of_a_promise(const analysis::AssumptionLedger& ledger, const std::string& contradiction,
                     std::vector<Violation>& violations) {
  using analysis::Assumption;
  const auto is_given = [&](Assumption each) {
    return !analysis::is_condition(each) && ledger[each].standing == analysis::Standing::condition;
  };
  const auto is_refuted = [&](const Violation& each) { return is_given(each.assumption); };
  if (std::ranges::any_of(violations, is_refuted)) return true;
  if (!is_given(Assumption::drained)) return false;
  violations.push_back({Assumption::drained, contradiction});
  return true;
}

}  // namespace

std::optional<Probe> probe(const scenario::Scenario& scenario, const analysis::Bounds& bounds,
                           const std::function<bool()>& interrupted) {
  json::Diagnostics diagnostics;
  const auto resolved = scenario::resolve(scenario, diagnostics);
  if (!resolved) return std::nullopt;
  scenario::Run run(*resolved);
  constexpr std::uint64_t events_a_slice = 100'000;
  while (!run.advance(events_a_slice))
    if (interrupted && interrupted()) return std::nullopt;
  results::RunResult result = evaluation::evaluate(run, false);
  std::vector<Violation> violations = violations_in(run, result);
  std::string contradiction = contradiction_in(*resolved, bounds, result);
  if (!contradiction.empty() && is_of_a_promise(bounds.ledger, contradiction, violations)) contradiction.clear();
  std::vector<std::uint64_t> broken = violations_of(result);
  return Probe{std::move(result.requirements),
               run.simulation().event_count(),
               run.simulation().digest().value(),
               std::move(violations),
               std::move(contradiction),
               std::move(broken),
               reactions_of(result)};
}

std::vector<std::optional<Probe>> probe_all(std::span<const FoundRun> runs, const analysis::Bounds& bounds,
                                            unsigned jobs, const std::function<bool()>& interrupted) {
  std::vector<std::optional<Probe>> probes(runs.size());
  std::vector<std::exception_ptr> failures(runs.size());
  std::atomic<std::size_t> next = 0;
  const auto work = [&] {
    for (std::size_t i = next++; i < runs.size(); i = next++) {
      try {
        probes[i] = probe(runs[i].scenario(), bounds, interrupted);
      } catch (...) {
        failures[i] = std::current_exception();
      }
    }
  };
  {
    std::vector<std::jthread> threads;  // joined also where the machine gives no further one
    for (unsigned t = 1; t < std::min<std::size_t>(jobs, runs.size()); ++t) threads.emplace_back(work);
    work();
  }
  for (const std::exception_ptr& failure : failures)
    if (failure) std::rethrow_exception(failure);
  return probes;
}

}  // namespace takt::verify
