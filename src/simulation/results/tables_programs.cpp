// SPDX-License-Identifier: Apache-2.0
// What result.json holds of Programs.
#include "json/record.hpp"
#include "results/run_result.hpp"

namespace takt::results {

namespace {

std::vector<std::pair<std::string, std::string>> states_of(const ProgramResult& program) {
  std::vector<std::pair<std::string, std::string>> states;
  for (std::size_t i = 0; i < program.participants.size(); ++i)
    states.emplace_back(program.participants[i], program.states[i]);
  return states;
}

std::vector<TimelineRow> timeline_of(const ProgramResult& program) {
  std::vector<TimelineRow> rows;
  for (const TimelineEntry& entry : program.timeline)
    rows.push_back({entry.at, entry.fault.empty() ? program.participants[entry.participant] : std::string(), entry.call,
                    entry.state, entry.fault});
  return rows;
}
bool is_no_fault(const TimelineRow& row) { return row.fault.empty(); }
bool is_fault(const TimelineRow& row) { return !row.fault.empty(); }
bool is_call(const TimelineRow& row) { return row.fault.empty() && !row.call.empty(); }
bool is_state(const TimelineRow& row) { return row.fault.empty() && row.call.empty(); }

bool has_round_trips(const ProgramResult& program) { return !program.round_trips.empty(); }

std::optional<std::string> node_of(const BindingResult& binding) {
  return binding.node.empty() ? std::nullopt : std::optional(binding.node);
}

}  // namespace

const json::Record& describe(json::Type<ReactionResult>) {
  static constexpr json::Output outputs[] = {
      json::output<&ReactionResult::kind>("kind", "`start`, `halt`, `suspend`, `resume` or `reset`."),
      json::output<&ReactionResult::initiator>(
          "initiator", "The node where it began; in a tree of Programs with the Program before it."),
      json::output<&ReactionResult::cause>(
          "cause",
          "`command`; `crash` and `cut`, from the instant of the fault; `silence`, words that stay away without such a "
          "fault, from the last one that came; `restart`, "
          "`leave`, `mismatch`; `nested`, passed on from the other group of a node."),
      json::output<&ReactionResult::began>("began_ps", "The instant of the cause."),
      json::output<&ReactionResult::completed>("completed_ps", "When all living participants were there; null: never."),
      json::output<&ReactionResult::duration>("duration_ps", "From the cause to that; null: never complete."),
      json::output<&ReactionResult::superseded>("superseded", "Something else was asked for before it was complete."),
  };
  static constexpr json::Record record{"reaction", "How a group followed a cause together.", outputs};
  return record;
}

const json::Record& describe(json::Type<BindingResult>) {
  static constexpr json::Output outputs[] = {
      json::output<&BindingResult::at>("at_ps", "When."),
      json::output<&BindingResult::role>("role", "The role."),
      json::output<&node_of>("node", "The node that has it from then on; null: nobody."),
  };
  static constexpr json::Record record{"binding", "A role got a node, or lost it.", outputs};
  return record;
}

const json::Record& describe(json::Type<ViolationResult>) {
  static constexpr json::Output outputs[] = {
      json::output<&ViolationResult::at>("at_ps", "When."),
      json::output<&ViolationResult::invariant>("invariant", "`S1` to `S5`."),
      json::output<&ViolationResult::participant>("participant", "The node where it was seen."),
      json::output<&ViolationResult::text>("text", "What was seen."),
  };
  static constexpr json::Record record{"violation", "A broken invariant of a Program.", outputs};
  return record;
}

const json::Record& describe(json::Type<TimelineRow>) {
  static constexpr json::Output outputs[] = {
      json::output<&TimelineRow::at>("at_ps", "When."),
      json::only_if<&is_no_fault>(json::output<&TimelineRow::participant>("participant", "The node."),
                                  "with `state` or `call`"),
      json::only_if<&is_state>(
          json::output<&TimelineRow::state>("state", "Its new state; `dead` while the node has failed."),
          "of a change of state"),
      json::only_if<&is_call>(json::output<&TimelineRow::call>("call", "A method and its status."), "of a call"),
      json::only_if<&is_fault>(
          json::output<&TimelineRow::fault>("fault", "What happens to the Program's nodes and links."), "of a fault"),
  };
  static constexpr json::Record record{"event", "A row of a Program's time line.", outputs};
  return record;
}

const json::Record& describe(json::Type<RoundTripResult>) {
  static constexpr json::Output outputs[] = {
      json::output<&RoundTripResult::request>("request", "The data set that is answered."),
      json::output<&RoundTripResult::count>("count", "Answers."),
      json::output<&RoundTripResult::time>(
          "time_ps", "From publishing the request to receiving the reply; null if nothing was answered."),
      json::output<&RoundTripResult::one_way>(
          "one_way_ps", "From publishing the request to the end of the work at it; null if nothing was answered."),
      json::output<&RoundTripResult::histogram>("histogram_ps", "`time_ps` by bucket."),
  };
  static constexpr json::Record record{"round_trip", "From publishing process data to receiving what answers it.",
                                       outputs};
  return record;
}

const json::Record& describe(json::Type<ProgramResult>) {
  static constexpr json::Output outputs[] = {
      json::output<&ProgramResult::variant>("variant", "`robust` or `paper`."),
      json::output<&ProgramResult::reactions>("reactions", "In the order of their causes."),
      json::output_if_any<&ProgramResult::tree_reactions>("tree_reactions",
                                                          "Reactions of the Program and all that are nested in it.",
                                                          "of the outermost Program of a tree"),
      json::output_if_any<&ProgramResult::bindings>("bindings", "Which node had which role, in the order of time.",
                                                    "of a Program with roles"),
      json::output<&states_of>("states", "States at the end; `dead`: the node has failed.", {.keys = "participant"}),
      json::output<&ProgramResult::violations>("violations", "Broken invariants, from the start of the run."),
      json::output<&timeline_of>("timeline",
                                 "Calls, changes of state and faults: the first ones, from the start of the run."),
      json::output<&ProgramResult::changes>("changes", "Changes of state in all."),
      json::output<&ProgramResult::process_data_received>("process_data_received",
                                                          "Messages of process data that participants got."),
      json::only_if<&has_round_trips>(json::outputs_by_name<&ProgramResult::round_trips, &RoundTripResult::reply>(
                                          "round_trips", "By the data set that answers.", {.keys = "reply"}),
                                      "with `replies`"),
  };
  static constexpr json::Record record{"program", "A Program and its participants.", outputs};
  return record;
}

}  // namespace takt::results
