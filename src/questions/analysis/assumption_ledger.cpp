// SPDX-License-Identifier: Apache-2.0
#include "analysis/assumption_ledger.hpp"

#include <utility>

#include "json/quantity.hpp"

namespace takt::analysis {

std::string_view name_of(Standing standing) {
  constexpr std::array<std::string_view, 4> names = {"discharged", "condition", "open", "violated"};
  return names[static_cast<std::size_t>(standing)];
}

AssumptionLedger::AssumptionLedger() {
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    const auto assumption = static_cast<Assumption>(i);
    entries_[i].text = text_of(assumption);
    if (is_condition(assumption)) entries_[i].standing = Standing::condition;
  }
}

void AssumptionLedger::state(Assumption assumption, std::string text, sim::Duration holds_from) {
  entry(assumption).text = std::move(text);
  entry(assumption).holds_from = holds_from;
}

void AssumptionLedger::leave_open(Assumption assumption, std::string why) {
  if (entry(assumption).standing == Standing::violated) return;
  entry(assumption).standing = Standing::open;
  entry(assumption).why = std::move(why);
}

void AssumptionLedger::discharge(Assumption assumption, std::string by) {
  if (entry(assumption).standing == Standing::violated) return;
  entry(assumption).standing = Standing::discharged;
  entry(assumption).why = std::move(by);
}

void AssumptionLedger::give(Assumption assumption, std::string by) {
  if (entry(assumption).standing == Standing::violated) return;
  entry(assumption).standing = Standing::condition;
  entry(assumption).why = std::move(by);
}

void AssumptionLedger::violate(Assumption assumption, std::string witness) {
  if (entry(assumption).standing == Standing::violated) return;
  entry(assumption).standing = Standing::violated;
  entry(assumption).why = std::move(witness);
}

std::string AssumptionLedger::refutation(const Assumptions& assumptions) const {
  for (const Assumption assumption : assumptions.list())
    if ((*this)[assumption].standing == Standing::violated)
      return rests_on(assumption) + "which is refuted: " + (*this)[assumption].why;
  return {};
}

std::string AssumptionLedger::objection(const Assumptions& assumptions, sim::Duration from) const {
  if (std::string refuted = refutation(assumptions); !refuted.empty()) return refuted;
  std::string open;
  for (const Assumption assumption : assumptions.list()) {
    const AssessedAssumption& each = (*this)[assumption];
    if (each.holds_from > from)
      return rests_on(assumption) + "which is so from " + json::to_text(each.holds_from) +
             " on; the requirement counts from " + json::to_text(from) + " on, see \"after\"";
    if (open.empty() && each.standing == Standing::open)
      open = rests_on(assumption) + "which is not proved" + (each.why.empty() ? "" : ": " + each.why);
  }
  return open;
}

}  // namespace takt::analysis
