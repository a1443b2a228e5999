// SPDX-License-Identifier: Apache-2.0
// What result.json holds of a run: the table of the whole, of requirements, streams and ports. See json/record.hpp.
#include <fmt/format.h>

#include "json/record.hpp"
#include "results/behaviour.hpp"
#include "results/run_result.hpp"

namespace takt::results {

const char* name_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::pass:
      return "pass";
    case Verdict::fail:
      return "fail";
    case Verdict::undecided:
      return "undecided";
  }
  return "?";
}

std::string titled(const std::string& name, const std::string& text) {
  return name.empty() ? text : name + ": " + text;
}

namespace {

std::uint32_t behaviour_of(const RunResult&) { return behaviour(); }  // results are written by the takt that ran them
std::string digest_text(const RunResult& result) { return fmt::format("{:016x}", result.digest); }
std::string verdict_text(const RunResult& result) {
  return result.nothing_required ? nothing_was_required : name_of(result.verdict);
}

bool has_cpus(const RunResult& result) { return !result.cpus.empty(); }
bool has_applications(const RunResult& result) { return !result.applications.empty(); }
bool has_signals(const RunResult& result) { return !result.signals.empty(); }

std::string verdict_of(const RequirementResult& requirement) { return name_of(requirement.verdict); }
bool has_least(const RequirementResult& requirement) { return requirement.least_limit.has_value(); }
bool is_figure(const RequirementResult& requirement) { return requirement.figure.has_value(); }
bool is_at_most(const RequirementResult& requirement) {
  return requirement.figure && !requirement.figure->within && requirement.figure->is_upper;
}
bool is_at_least(const RequirementResult& requirement) {
  return requirement.figure && !requirement.figure->within && !requirement.figure->is_upper;
}
bool is_equal(const RequirementResult& requirement) { return requirement.figure && requirement.figure->within; }
std::string figure_name(const RequirementResult& requirement) { return requirement.figure->name; }
std::optional<double> figure_found(const RequirementResult& requirement) { return requirement.figure->found; }
double figure_asked(const RequirementResult& requirement) { return requirement.figure->asked; }
double figure_within(const RequirementResult& requirement) { return *requirement.figure->within; }
std::string figure_unit(const RequirementResult& requirement) { return requirement.figure->unit; }

Duration oldest_in_flight(const StreamResult& stream) { return stream.oldest_in_flight.value_or(Duration()); }

}  // namespace

const json::Record& describe(json::Type<LatencySummary>) {
  static constexpr json::Output outputs[] = {
      json::output<&LatencySummary::min>("min", "The shortest, exactly."),
      json::output<&LatencySummary::mean>("mean", "The mean, exactly."),
      json::output<&LatencySummary::p50>("p50", "The median: the upper edge of a bucket that is at most 1/128 wide."),
      json::output<&LatencySummary::p99>("p99", "The 99th percentile, likewise."),
      json::output<&LatencySummary::max>("max", "The longest, exactly."),
      json::output<&LatencySummary::stddev>("stddev", "The standard deviation, exactly."),
  };
  static constexpr json::Record record{"latency", "How long something took, each time.", outputs};
  return record;
}

const json::Record& describe(json::Type<HistogramBucket>) {
  static constexpr json::Output outputs[] = {
      json::output<&HistogramBucket::from>("from", "The shortest that falls into the bucket."),
      json::output<&HistogramBucket::to>("to", "The longest."),
      json::output<&HistogramBucket::count>("count", "How many did."),
  };
  static constexpr json::Record record{"bucket", "A bucket of a histogram.", outputs, true};
  return record;
}

const json::Record& describe(json::Type<RequirementResult>) {
  static constexpr json::Output outputs[] = {
      json::output_if_any<&RequirementResult::name>("name", "The name that the scenario gives it.",
                                                    "where it gives one"),
      json::output<&RequirementResult::text>("text", "What was asked."),
      json::output<&verdict_of>("verdict", "`pass`, `fail` or `undecided`."),
      json::output<&RequirementResult::measured>("measured_ps", "What was found; null where it is no time."),
      json::output<&RequirementResult::limit>("limit_ps", "What was asked; null where it is no time."),
      json::only_if<&has_least>(
          json::output<&RequirementResult::least_measured>("least_measured_ps", "The shortest that was found."),
          "of a time that must be equal to something"),
      json::only_if<&has_least>(
          json::output<&RequirementResult::least_limit>("least_limit_ps", "The shortest that was allowed."),
          "of a time that must be equal to something"),
      json::output_if_any<&RequirementResult::from>("from_ps", "What began then or later counts.",
                                                    "if it does not count from the start"),
      json::output<&RequirementResult::remark>("remark", "What was counted, or why it failed without a figure."),
      json::only_if<&is_figure>(json::output<&figure_name>("figure", "The figure."), "of a limit on a figure"),
      json::only_if<&is_figure>(
          json::output<&figure_found>("found", "Its value in `unit`; null if the run has no such figure."),
          "of a limit on a figure"),
      json::only_if<&is_at_most>(json::output<&figure_asked>("at_most", "The limit."), "of such a limit on a figure"),
      json::only_if<&is_at_least>(json::output<&figure_asked>("at_least", "The limit."), "of such a limit on a figure"),
      json::only_if<&is_equal>(json::output<&figure_asked>("equal", "What it must be."), "of such a limit on a figure"),
      json::only_if<&is_equal>(json::output<&figure_within>("within", "How far it may be from that."),
                               "beside `equal`"),
      json::only_if<&is_figure>(json::output<&figure_unit>("unit", "The unit of the figure and its limit."),
                                "of a limit on a figure"),
  };
  static constexpr json::Record record{
      "requirement", "A requirement of the scenario, or a Program's invariants, and what became of it.", outputs};
  return record;
}

const json::Record& describe(json::Type<StreamResult>) {
  static constexpr json::Output outputs[] = {
      json::output<&StreamResult::sent>(
          "sent", "Frames that the talker produced. sent + copies = delivered + dropped + in_flight."),
      json::output<&StreamResult::delivered>("delivered", "Frames that the listeners got."),
      json::output<&StreamResult::lost>("lost",
                                        "Frames that no copy brings to a listener any more, for each listener."),
      json::output<&StreamResult::dropped>("dropped",
                                           "Copies that were dropped, by reason; only reasons that occurred.",
                                           {.keys = "reason", .is_zero_if_absent = true}),
      json::output<&StreamResult::copies>("copies", "Made for further listeners or paths."),
      json::output<&StreamResult::in_flight>("in_flight", "Copies under way at the end."),
      json::output<&oldest_in_flight>(
          "oldest_in_flight_ps",
          "How long the oldest frame that a listener still waits for has been under way; 0 if none has."),
      json::output<&StreamResult::listeners>("listeners", "Nodes that the stream goes to."),
      json::output<&StreamResult::latency>(
          "latency_ps",
          "From the moment the application hands a frame over to the moment the receiving application gets it, with "
          "the delays of both operating systems; null "
          "if nothing was delivered."),
  };
  static constexpr json::Record record{"stream", "Frames of one stream.", outputs};
  return record;
}

const json::Record& describe(json::Type<PortResult>) {
  static constexpr json::Output outputs[] = {
      json::output<&PortResult::node>("node", "Whose port it is."),
      json::output<&PortResult::port>("port", "Its number, from 0."),
      json::output<&PortResult::peer>("peer", "The node at the other end."),
      json::output<&PortResult::frames>("frames", "Frames that were sent."),
      json::output<&PortResult::dropped>("dropped", "Frames that were dropped at it."),
      json::output<&PortResult::queue_peak>("queue_peak", "The most frames that waited in one queue."),
      json::output<&PortResult::utilisation>(
          "utilisation", "Share of the simulated time for which the medium was taken, from 0 to 1."),
      json::output<&PortResult::fragments_cut>("fragments_cut",
                                               "How often a frame was cut for an express one (preemption)."),
      json::output<&PortResult::frames_cut_through>("frames_cut_through",
                                                    "Frames that began to leave before they had come wholly."),
      json::output<&PortResult::bad_fcs_forwarded>("bad_fcs_forwarded", "Damaged ones among those."),
      json::output<&PortResult::transmission_overrun>(
          "transmission_overrun", "Frames that were still on the medium when their gate closed (IEEE 802.1Q 8.6.8.4)."),
  };
  static constexpr json::Record record{"port", "An egress port that sent or dropped something.", outputs};
  return record;
}

const json::Record& describe(json::Type<QueueResult>) {
  static constexpr json::Output outputs[] = {
      json::output<&QueueResult::node>("node", "Whose port it is."),
      json::output<&QueueResult::port>("port", "Its number, from 0."),
      json::output<&QueueResult::peer>("peer", "The node at the other end."),
      json::output<&QueueResult::traffic_class>("class", "The traffic class, 7 is the most urgent."),
      json::output<&QueueResult::frames>("frames", "The most frames that waited in it.", {.is_zero_if_absent = true}),
      json::output<&QueueResult::octets>(
          "octets", "The most octets that waited in it, DA to FCS; not necessarily when the most frames did.",
          {.is_zero_if_absent = true}),
  };
  static constexpr json::Record record{"queue",
                                       "The queue of a traffic class at an egress port in which frames have waited. "
                                       "The one that is being sent does not count.",
                                       outputs};
  return record;
}

const json::Record& describe(json::Type<RunResult>) {
  static constexpr json::Output outputs[] = {
      json::output<&RunResult::version>("takt", "The version of takt."),
      json::output<&behaviour_of>(
          "behaviour",
          "The number of behaviour of takt: figures of one scenario and seed can be compared where it is the same."),
      json::output<&RunResult::scenario>("scenario", "Its name."),
      json::output<&RunResult::seed>("seed", "The seed of all that is random."),
      json::output<&RunResult::simulated>("simulated_ps", "How far the run came."),
      json::output<&RunResult::partial>("partial", "It was interrupted."),
      json::output<&digest_text>("digest",
                                 "16 hex digits over what happened: every production, delivery (with its age) and loss "
                                 "(with its reason) of a frame, every transition, word and call of a Program, "
                                 "faults and the rest of the script, what clocks did. Equal for equal scenario and "
                                 "seed on every machine; runs that differ in any of it have another one."),
      json::output<&RunResult::events>("events", "Events handled."),
      json::output_if_any<&RunResult::from>("from_ps", "The figures are of what began then or later.",
                                            "with `warm_up`"),
      json::output<&verdict_text>(
          "verdict",
          "`pass`, `fail`, `undecided` for a partial run that has not failed and for clocks that "
          "follow several grandmasters, or `nothing was "
          "required` (exit status 0) where neither the scenario nor a Program asks for "
          "anything.",
          {.is_judgement = true}),
      json::output<&RunResult::requirements>("requirements", "What was required.", {.is_judgement = true}),
      json::outputs_by_name<&RunResult::streams, &StreamResult::name>("streams", "What became of frames.",
                                                                      {.keys = "stream"}),
      json::outputs_by_name<&RunResult::programs, &ProgramResult::name>("programs", "What Programs did.",
                                                                        {.keys = "program"}),
      json::only_if<&has_applications>(
          json::outputs_by_name<&RunResult::applications, &ApplicationResult::name>(
              "applications", "What applications, gateways and persistence services did.", {.keys = "application"}),
          "where there are some"),
      json::only_if<&has_cpus>(json::outputs_by_name<&RunResult::cpus, &CpuResult::node>(
                                   "cpus", "What the processors of hosts did.", {.keys = "node"}),
                               "where there are some"),
      json::only_if<&has_signals>(json::outputs_by_name<&RunResult::signals, &SignalResult::name>(
                                      "signals", "What digital outputs did.", {.keys = "signal"}),
                                  "where there are some"),
      json::output<&RunResult::ports>("ports", "Egress ports that sent or dropped something.",
                                      {.counts_from_start = true}),
      json::output<&RunResult::queues>("queues", "Queues of traffic classes in which frames have waited.",
                                       {.counts_from_start = true}),
      json::output<&RunResult::dropped>(
          "dropped", "Frames that were dropped in the whole network, by reason; only reasons that occurred.",
          {.keys = "reason", .is_zero_if_absent = true}),
      json::output<&RunResult::clocks>("clocks", "Nodes with gPTP."),
      json::output<&RunResult::grandmasters>("grandmasters", "Who gave the time when: the first 4096 changes.",
                                             {.counts_from_start = true}),
      json::output<&RunResult::gptp_links>("gptp_links", "Ports of nodes with gPTP.", {.counts_from_start = true}),
      json::outputs_by_name<&RunResult::clock_differences, &ClockDifferenceResult::name>(
          "clock_differences",
          "How far clocks were apart: of `all` nodes, of those that `ways` of streams join (with a number where "
          "streams leave the network in several parts), and of those that a requirement names.",
          {.keys = "nodes"}),
      json::outputs_by_name<&RunResult::ingress, &IngressResult::node>(
          "ingress", "The ingress of switches that have met a frame, with names and meanings of IEEE 802.1Q 8.6.5.",
          {.keys = "node", .counts_from_start = true}),
      json::output<&RunResult::redundancy>("redundancy", "Splitting and joining of streams (IEEE 802.1CB 10).",
                                           {.counts_from_start = true}),
  };
  static constexpr json::Record record{"result", "A run.", outputs};
  return record;
}

}  // namespace takt::results
