// SPDX-License-Identifier: Apache-2.0
// What result.json holds of clocks.
#include <algorithm>

#include "json/record.hpp"
#include "results/clock_result.hpp"

namespace takt::results {

namespace {

sim::Duration greatest_either_way(const ClockResult& clock) {
  return std::max(clock.greatest, sim::Duration() - clock.least);
}

const json::Record& offset() {
  static constexpr json::Output outputs[] = {
      json::output<&ClockResult::least>("min_ps", "The least."),
      json::output<&ClockResult::mean>("mean_ps", "The mean."),
      json::output<&ClockResult::rms>("rms_ps", "The root of the mean square."),
      json::output<&ClockResult::greatest>("max_ps", "The greatest."),
      json::output<&greatest_either_way>("abs_max_ps", "The greatest either way."),
      json::output<&ClockResult::greatest_at>("abs_max_at_ps", "The first look that showed it; null: none was taken."),
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
      json::output<&ClockResult::state>(
          "state",
          "At the end: `free-running`, `acquiring`, `locked` (its servo, to its present grandmaster), `holdover` (no "
          "Sync any more, or none yet from a new grandmaster), `grandmaster` or `down`."),
      json::output<&ClockResult::time_to_lock>(
          "time_to_lock_ps",
          "From the start to being locked first; null: never, as of who was grandmaster all the time."),
      json::output<&ClockResult::has_led>("has_led", "Another node took its time from it at some look."),
      json::output<&ClockResult::samples>("samples", "Samples of its offset."),
      json::part<ClockResult, &offset>("offset", "Since it was locked first."),
      json::output<&ClockResult::frequency_error_ppt>(
          "rate_error_ppt", "At the end: the rate of its clock against the grandmaster's.", {.unit = "ppt"}),
      json::output<&ClockResult::steps>("steps", "Jumps of its time.", {.counts_from_start = true}),
      json::output<&ClockResult::messages>("messages", "Messages of gPTP that it sent.", {.counts_from_start = true}),
      json::output<&ClockResult::changes>("history", "The first 4096 changes."),
  };
  static constexpr json::Record record{"clock", "A node with gPTP.", outputs};
  return record;
}

const json::Record& describe(json::Type<GrandmasterResult>) {
  static constexpr json::Output outputs[] = {
      json::output<&GrandmasterResult::at>("at_ps", "When."),
      json::output<&GrandmasterResult::node>("node", "The grandmaster."),
      json::output<&GrandmasterResult::event>(
          "event",
          "`leads`: another node is locked to it; `lost`: it went down; `replaced`: nobody follows it any more."),
  };
  static constexpr json::Record record{"grandmaster_change", "A change of who gives the time.", outputs};
  return record;
}

const json::Record& describe(json::Type<GptpLinkResult>) {
  static constexpr json::Output outputs[] = {
      json::output<&GptpLinkResult::node>("node", "Whose port it is."),
      json::output<&GptpLinkResult::port>("port", "Its number, from 0."),
      json::output<&GptpLinkResult::peer>("peer", "The node at the other end."),
      json::output<&GptpLinkResult::is_capable>(
          "as_capable", "The port handles Sync and Announce (IEEE 802.1AS-2020 11.2.2), at the end."),
      json::output<&GptpLinkResult::why_not>("why_not", "Why it does not; empty if it does."),
      json::output<&GptpLinkResult::since>("since_ps", "It has been as it is since then."),
      json::output<&GptpLinkResult::link_delay>("link_delay_ps",
                                                "meanLinkDelay as the port has measured it; null: not at all."),
      json::output<&GptpLinkResult::threshold>("threshold_ps", "Beyond which it would be too long; null: no delay is."),
  };
  static constexpr json::Record record{"gptp_link", "A port of a node with gPTP.", outputs};
  return record;
}

const json::Record& describe(json::Type<ClockDifferenceResult>) {
  static constexpr json::Output outputs[] = {
      json::output<&ClockDifferenceResult::samples>("samples", "Looks."),
      json::output<&ClockDifferenceResult::greatest>(
          "greatest_ps", "The greatest difference between two clocks of the nodes at one look; null: nobody looked."),
      json::output<&ClockDifferenceResult::at>("at_ps", "The first look that showed it."),
      json::output<&ClockDifferenceResult::behind>("behind", "The node whose clock was behind."),
      json::output<&ClockDifferenceResult::ahead>("ahead", "And the one whose clock was ahead."),
  };
  static constexpr json::Record record{"clock_difference",
                                       "How far clocks of some nodes were apart, whomever they followed.", outputs};
  return record;
}

}  // namespace takt::results
