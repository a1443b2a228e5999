// SPDX-License-Identifier: Apache-2.0
// What becomes of each assumption in one scenario: the only place that says whether a conclusion stands.
//
// An assumption is discharged by the scenario or by another proof, is a condition that only the plant can keep, is
// open, or is violated: by the scenario itself, or in a run that was watched (verify/monitor.hpp). Nothing is proved
// that rests on an open or a violated one.
#pragma once

#include <array>
#include <string>

#include "analysis/assumption.hpp"
#include "json/type.hpp"
#include "sim/time.hpp"

namespace takt::analysis {

enum class Standing : std::uint8_t { discharged, condition, open, violated };
std::string_view name_of(Standing standing);

/// An assumption in a scenario.
struct AssessedAssumption {
  Standing standing = Standing::open;
  std::string text;          ///< what is assumed, with this scenario's figures: "clocks within 490 ns from 5 s on"
  std::string why;           ///< what discharges or violates it, or why it is open
  sim::Duration holds_from;  ///< since the start; a conclusion that counts from earlier does not stand
};
/// What reports hold of it, but for its name.
const json::Record& describe(json::Type<AssessedAssumption>);

class AssumptionLedger {
 public:
  /// Conditions are conditions, all others are open.
  AssumptionLedger();

  const AssessedAssumption& operator[](Assumption assumption) const {
    return entries_[static_cast<std::size_t>(assumption)];
  }

  /// Says what is assumed in words of the scenario.
  void state(Assumption assumption, std::string text, sim::Duration holds_from = {});
  void leave_open(Assumption assumption, std::string why);
  /// A data sheet promises it: a condition of what rests on it, unless something violates it.
  void give(Assumption assumption, std::string by);
  /// No effect on what is violated: a proof does not undo a run.
  void discharge(Assumption assumption, std::string by);
  /// The first witness is kept.
  void violate(Assumption assumption, std::string witness);

  /// Why a conclusion does not stand that rests on `assumptions` and counts from `from` on; empty if it does.
  std::string objection(const Assumptions& assumptions, sim::Duration from) const;
  /// Why a conclusion does not stand that rests on `assumptions`, whenever it counts from; empty if none of them is
  /// violated.
  std::string refutation(const Assumptions& assumptions) const;

 private:
  std::string rests_on(Assumption assumption) const { return "rests on \"" + (*this)[assumption].text + "\", "; }
  AssessedAssumption& entry(Assumption assumption) { return entries_[static_cast<std::size_t>(assumption)]; }
  std::array<AssessedAssumption, static_cast<std::size_t>(Assumption::count)> entries_;
};

}  // namespace takt::analysis
