// SPDX-License-Identifier: Apache-2.0
// What result.json holds of the ingress of switches and of redundancy.
#include "json/record.hpp"
#include "results/ingress_result.hpp"

namespace takt::results {

namespace {

std::optional<std::string> stream_of(const StreamFilterResult& filter) {
  return filter.stream.empty() ? std::nullopt : std::optional(filter.stream);
}
std::uint64_t green(const FlowMeterResult& meter) { return meter.frames[0]; }
std::uint64_t yellow(const FlowMeterResult& meter) { return meter.frames[1]; }
std::uint64_t red(const FlowMeterResult& meter) { return meter.frames[2]; }

}  // namespace

const json::Record& describe(json::Type<StreamFilterResult>) {
  static constexpr json::Output outputs[] = {
      json::output<&stream_of>("stream", "The stream that it is for; null: any."),
      json::output<&StreamFilterResult::priority>("pcp", "The priority that it is for; null: any."),
      json::output<&StreamFilterResult::matching>("matching",
                                                  "Frames that matched. matching = passing_sdu + not_passing_sdu."),
      json::output<&StreamFilterResult::passing>(
          "passing", "Frames that passed the stream gate. passing_sdu = passing + not_passing."),
      json::output<&StreamFilterResult::not_passing>("not_passing", "Frames that did not."),
      json::output<&StreamFilterResult::passing_sdu>("passing_sdu", "Frames that were not too long."),
      json::output<&StreamFilterResult::not_passing_sdu>("not_passing_sdu", "Frames that were."),
      json::output<&StreamFilterResult::red>("red", "Frames that the flow meter discarded, among the passing."),
      json::output<&StreamFilterResult::blocked_due_to_oversize>("blocked_due_to_oversize",
                                                                 "It is blocked since a frame was too long."),
  };
  static constexpr json::Record record{"stream_filter", "A stream filter (8.6.5.3).", outputs};
  return record;
}

const json::Record& describe(json::Type<StreamGateResult>) {
  static constexpr json::Output outputs[] = {
      json::output<&StreamGateResult::passed>("passed", "Frames that passed."),
      json::output<&StreamGateResult::closed>("closed", "Frames that came while it was closed."),
      json::output<&StreamGateResult::octets_exceeded>("octets_exceeded", "Frames beyond the octets of an interval."),
      json::output<&StreamGateResult::closed_due_to_invalid_rx>(
          "closed_due_to_invalid_rx", "It is closed for good since a frame came while it was closed."),
      json::output<&StreamGateResult::closed_due_to_octets_exceeded>(
          "closed_due_to_octets_exceeded", "It is closed for good since there were too many octets."),
  };
  static constexpr json::Record record{"stream_gate", "A stream gate (8.6.5.4).", outputs};
  return record;
}

const json::Record& describe(json::Type<FlowMeterResult>) {
  static constexpr json::Output outputs[] = {
      json::output<&green>("green", "Frames within the committed rate."),
      json::output<&yellow>("yellow", "Frames within the excess rate."),
      json::output<&red>("red", "Frames beyond."),
      json::output<&FlowMeterResult::discarded>("discarded", "Frames that were discarded."),
      json::output<&FlowMeterResult::marks_all_red>("marks_all_red", "It marks all red since one was."),
  };
  static constexpr json::Record record{"flow_meter", "A flow meter (8.6.5.5).", outputs};
  return record;
}

const json::Record& describe(json::Type<AtsSchedulerResult>) {
  static constexpr json::Output outputs[] = {
      json::output<&AtsSchedulerResult::passed>("passed", "Frames that got an eligibility time."),
      json::output<&AtsSchedulerResult::discarded>("discarded", "Frames that would have stayed too long."),
      json::output<&AtsSchedulerResult::longest_hold>("longest_hold_ps", "The greatest eligibility time less arrival."),
  };
  static constexpr json::Record record{"ats_scheduler", "A scheduler of asynchronous traffic shaping (8.6.5.6).",
                                       outputs};
  return record;
}

const json::Record& describe(json::Type<IngressResult>) {
  static constexpr json::Output outputs[] = {
      json::output<&IngressResult::unidentified>("unidentified", "Frames of no stream of its table."),
      json::output<&IngressResult::filters>("filters", "Stream filters, in the order of the scenario."),
      json::outputs_by_name<&IngressResult::gates, &StreamGateResult::name>("gates", "Stream gates.", {.keys = "gate"}),
      json::outputs_by_name<&IngressResult::meters, &FlowMeterResult::name>("meters", "Flow meters.",
                                                                            {.keys = "meter"}),
      json::outputs_by_name<&IngressResult::ats, &AtsSchedulerResult::name>(
          "ats", "Schedulers of asynchronous traffic shaping.", {.keys = "scheduler"}),
  };
  static constexpr json::Record record{"ingress", "The ingress of a switch.", outputs};
  return record;
}

const json::Record& describe(json::Type<SplitResult>) {
  static constexpr json::Output outputs[] = {
      json::output<&SplitResult::node>("node", "Where."),
      json::output<&SplitResult::stream>("stream", "The stream."),
      json::output<&SplitResult::members>("members", "Member streams."),
      json::output<&SplitResult::frames>("frames", "Frames that were split."),
      json::output<&SplitResult::copies>("copies", "Copies that were made beyond them."),
  };
  static constexpr json::Record record{"split", "Where a stream is split into members.", outputs};
  return record;
}

const json::Record& describe(json::Type<RecoveryCounters>) {
  static constexpr json::Output outputs[] = {
      json::output<&RecoveryCounters::passed>("passed", "Frames that went on."),
      json::output<&RecoveryCounters::discarded>("discarded", "Frames that did not."),
      json::output<&RecoveryCounters::out_of_order>("out_of_order", "Frames that came later than a younger one."),
      json::output<&RecoveryCounters::rogue>("rogue", "Frames outside the history, among the discarded."),
      json::output<&RecoveryCounters::lost>("lost",
                                            "Numbers that nobody has seen, those before the first frame not counted."),
      json::output<&RecoveryCounters::tagless>("tagless", "Frames without a redundancy tag."),
      json::output<&RecoveryCounters::resets>("resets", "Time-outs; the reset at the start is none."),
  };
  static constexpr json::Record record{"recovery_counters",
                                       "Counters of a sequence recovery function (IEEE 802.1CB 7.4.3).", outputs};
  return record;
}

const json::Record& describe(json::Type<LatentErrorResult>) {
  static constexpr json::Output outputs[] = {
      json::output<&LatentErrorResult::paths>("paths", "Paths that should be there."),
      json::output<&LatentErrorResult::errors>("errors", "Tests that failed."),
      json::output<&LatentErrorResult::resets>("resets", "Resets of its counters."),
      json::output<&LatentErrorResult::first>("first_ps", "When the first error was signalled; null: never."),
  };
  static constexpr json::Record record{"latent_errors", "Latent error detection (IEEE 802.1CB 7.4.4).", outputs};
  return record;
}

const json::Record& describe(json::Type<RecoveryResult::Individual>) {
  static constexpr json::Output outputs[] = {
      json::output<&RecoveryResult::Individual::member>("member",
                                                        "The member stream; null: frames of no member's address."),
      json::output<&RecoveryResult::Individual::port>("port", "The port where they come in."),
      json::spread<&RecoveryResult::Individual::counters>(),
  };
  static constexpr json::Record record{"individual_recovery", "Recovery of one member at one port.", outputs};
  return record;
}

const json::Record& describe(json::Type<RecoveryResult>) {
  static constexpr json::Output outputs[] = {
      json::output<&RecoveryResult::node>("node", "Where."),
      json::output<&RecoveryResult::stream>("stream", "The stream."),
      json::spread<&RecoveryResult::counters>(),
      json::output<&RecoveryResult::latent_errors>("latent_errors", "Null without latent error detection."),
      json::output<&RecoveryResult::individual>("individual", "Of one member at one port each."),
  };
  static constexpr json::Record record{"recovery", "Where the members of a stream become one again.", outputs};
  return record;
}

const json::Record& describe(json::Type<RedundancyResult>) {
  static constexpr json::Output outputs[] = {
      json::output<&RedundancyResult::splits>("splits", "Where streams are split."),
      json::output<&RedundancyResult::recoveries>("recoveries", "Where they become one again."),
  };
  static constexpr json::Record record{"redundancy", "Splitting and joining of streams.", outputs};
  return record;
}

}  // namespace takt::results
