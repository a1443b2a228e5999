// What result.json holds of clocks.
#include <algorithm>

#include "json/record.hpp"
#include "results/clock_result.hpp"

namespace takt::results {

namespace {

sim::Duration greatest_either_way(const ClockResult& clock) { return std::max(clock.greatest, sim::Duration() - clock.least); }

const json::Record& offset() {
  static constexpr json::Output outputs[] = {
      json::output<&ClockResult::least>("min_ps", "The least."),
      json::output<&ClockResult::mean>("mean_ps", "The mean."),
      json::output<&ClockResult::rms>("rms_ps", "The root of the mean square."),
      json::output<&ClockResult::greatest>("max_ps", "The greatest."),
      json::output<&greatest_either_way>("abs_max_ps", "The greatest either way."),
  };
  static constexpr json::Record record{"offset", "A clock less that of its grandmaster.", outputs};
  return record;
}

}  // namespace

const json::Record& describe(json::Type<ClockChangeResult>) {
  static constexpr json::Output outputs[] = {
      json::output<&ClockChangeResult::at>("at_ps", "From when on."),
      json::output<&ClockChangeResult::grandmaster>("grandmaster", "Whom it follows."),
      json::output<&ClockChangeResult::state>("state", "As below; a grandmaster is `locked` to itself."),
  };
  static constexpr json::Record record{"clock_change", "A row of a clock's history.", outputs};
  return record;
}

const json::Record& describe(json::Type<ClockResult>) {
  static constexpr json::Output outputs[] = {
      json::output<&ClockResult::node>("node", "Whose clock it is."),
      json::output<&ClockResult::grandmaster>("grandmaster", "Whom it follows at the end."),
      json::output<&ClockResult::state>("state", "At the end: `free-running`, `acquiring`, `locked` (its servo, to its present grandmaster), `holdover` (no Sync any more, or none yet from a new grandmaster), `grandmaster` or `down`."),
      json::output<&ClockResult::time_to_lock>("time_to_lock_ps", "From the start to being locked first; null: never."),
      json::output<&ClockResult::samples>("samples", "Samples of its offset."),
      json::part<ClockResult, &offset>("offset", "Since it was locked first."),
      json::output<&ClockResult::frequency_error_ppt>("rate_error_ppt", "At the end: the rate of its clock against the grandmaster's.", {.unit = "ppt"}),
      json::output<&ClockResult::steps>("steps", "Jumps of its time.", {.counts_from_start = true}),
      json::output<&ClockResult::messages>("messages", "Messages of gPTP that it sent.", {.counts_from_start = true}),
      json::output<&ClockResult::changes>("history", "The first 4096 changes."),
  };
  static constexpr json::Record record{"clock", "A node with gPTP.", outputs};
  return record;
}

}  // namespace takt::results
