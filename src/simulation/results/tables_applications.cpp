// SPDX-License-Identifier: Apache-2.0
// What result.json holds of applications with threads, gateways, persistence services and digital outputs.
#include "json/record.hpp"
#include "results/application_result.hpp"

namespace takt::results {

namespace {

bool publishes(const ThreadResult& thread) { return thread.publishes; }
bool subscribes(const ThreadResult& thread) { return !thread.publishes; }
bool measures_round_trips(const ThreadResult& thread) { return thread.measures_round_trips; }
bool has_values(const ThreadResult& thread) { return !thread.publishes && thread.values; }
bool has_filter(const ThreadResult& thread) { return thread.filtered.has_value(); }

std::string kind_of(const ApplicationResult& application) {
  return application.is_gateway ? "gateway" : application.is_service ? "persistence" : "application";
}
bool has_buffer(const ApplicationResult& application) { return application.buffer.has_value(); }

const json::Record& discovery() {
  static constexpr json::Output outputs[] = {
      json::output<&ParticipantResult::discovery_messages>("messages", "Messages of discovery that were sent."),
      json::output<&ParticipantResult::discovery_octets>("octets", "Octets of them."),
      json::output<&ParticipantResult::participants_found>("participants_found", "Other participants that came."),
      json::output<&ParticipantResult::participants_lost>("participants_lost",
                                                          "Other participants that went, or fell silent."),
      json::output<&ParticipantResult::matches>("matches", "Of its endpoints with others."),
      json::output<&ParticipantResult::time_to_match>("time_to_match_ps",
                                                      "From its last start to the last match since; null: none."),
  };
  static constexpr json::Record record{"discovery", "Simple discovery (DDSI-RTPS 8.5).", outputs};
  return record;
}

const json::Record& age() {
  static constexpr json::Output outputs[] = {
      json::output<&BufferResult::age_min>("min", "The least."),
      json::output<&BufferResult::age_mean>("mean", "The mean."),
      json::output<&BufferResult::age_max>("max", "The greatest."),
  };
  static constexpr json::Record record{"age", "How old samples were when they were forwarded.", outputs};
  return record;
}

}  // namespace

const json::Record& describe(json::Type<CriterionResult>) {
  static constexpr json::Output outputs[] = {
      json::output<&CriterionResult::percent>(
          "percent", "Share of what was expected that happened; null without a test.", {.unit = "%"}),
      json::output<&CriterionResult::tests>("tests", "Windows that were looked at."),
      json::output<&CriterionResult::window>("window_ps", "Length of a window."),
      json::output<&CriterionResult::expected>("expected", "Expected in all tests."),
      json::output<&CriterionResult::counted>("counted", "Happened, in each window at most as many as expected."),
      json::output<&CriterionResult::beyond>("beyond", "Happened in windows beyond what was expected there."),
      json::output<&CriterionResult::windows_below>("windows_below", "Windows with fewer than expected."),
      json::output<&CriterionResult::windows_above>("windows_above", "Windows with more than expected."),
      json::output<&CriterionResult::discarded>("discarded", "Tests that do not count."),
  };
  static constexpr json::Record record{"criterion", "In each window happenings are counted against those expected.",
                                       outputs};
  return record;
}

const json::Record& describe(json::Type<DurationSummary>) {
  static constexpr json::Output outputs[] = {
      json::output<&DurationSummary::count>("count", "How many."),
      json::output<&DurationSummary::min>("min", "The shortest."),
      json::output<&DurationSummary::mean>("mean", "The mean."),
      json::output<&DurationSummary::max>("max", "The longest."),
      json::output<&DurationSummary::deviation>("deviation", "The standard deviation."),
  };
  static constexpr json::Record record{"durations", "Durations of happenings of one kind.", outputs};
  return record;
}

const json::Record& describe(json::Type<ThreadResult>) {
  static constexpr json::Output outputs[] = {
      json::only_if<&publishes>(json::output<&ThreadResult::topic>("publishes", "The topic."),
                                "of a publishing thread"),
      json::only_if<&subscribes>(json::output<&ThreadResult::topic>("subscribes", "The topic."),
                                 "of a subscribing thread"),
      json::output<&ThreadResult::every>("every_ps", "Its period."),
      json::output<&ThreadResult::activations>("activations", "Calls that were due."),
      json::output<&ThreadResult::done>("done", "Calls that took place."),
      json::output<&ThreadResult::missed>("missed", "Calls that did not, because the one before had not ended."),
      json::output<&ThreadResult::response>("response_ps", "From when a call was due to its end; null without a call."),
      json::output<&ThreadResult::calls>("calls", "Criterion 1: calls against those due."),
      json::only_if<&publishes>(json::output<&ThreadResult::published>("published", "Samples."),
                                "of a publishing thread"),
      json::only_if<&publishes>(json::output<&ThreadResult::refused>("refused", "Samples that were not taken."),
                                "of a publishing thread"),
      json::only_if<&publishes>(json::output<&ThreadResult::timed_out>(
                                    "timed_out", "Samples that waited for room for too long and were not published."),
                                "of a publishing thread"),
      json::only_if<&subscribes>(json::output<&ThreadResult::arrived>("arrived", "Samples that calls found."),
                                 "of a subscribing thread"),
      json::only_if<&subscribes>(
          json::output<&ThreadResult::buffered>("buffered", "Samples that waited in the buffer."),
          "of a subscribing thread"),
      json::only_if<&subscribes>(
          json::output<&ThreadResult::overwritten>("overwritten", "Samples that newer ones took the place of."),
          "of a subscribing thread"),
      json::only_if<&subscribes>(json::output<&ThreadResult::lost>("lost", "Samples that never came."),
                                 "of a subscribing thread"),
      json::only_if<&has_filter>(
          json::output<&ThreadResult::filtered>("filtered", "Samples that came and that its `filter` kept out."),
          "with `filter`"),
      json::only_if<&measures_round_trips>(
          json::output<&ThreadResult::round_trip>("round_trip_ps",
                                                  "From the call that publishes a value to the call that takes it when "
                                                  "it has come back; null if none has."),
          "with `round_trip`"),
      json::only_if<&has_values>(
          json::output<&ThreadResult::values>("values", "Criterion 2: values against those expected."),
          "of a subscribing thread whose publisher is known, without `filter`"),
  };
  static constexpr json::Record record{"thread", "A thread of an application.", outputs};
  return record;
}

const json::Record& describe(json::Type<ParticipantResult>) {
  static constexpr json::Output outputs[] = {
      json::output<&ParticipantResult::domain>("domain", "Its domain."),
      json::output<&ParticipantResult::messages_sent>("messages_sent", "RTPS messages."),
      json::output<&ParticipantResult::octets_sent>("octets_sent", "Octets of them."),
      json::output<&ParticipantResult::messages_received>("messages_received", "RTPS messages."),
      json::output<&ParticipantResult::heartbeats_sent>("heartbeats_sent", "Heartbeats (DDSI-RTPS 8.3.7.5)."),
      json::output<&ParticipantResult::acknacks_sent>("acknacks_sent", "Acknowledgements (8.3.7.1)."),
      json::output<&ParticipantResult::resent>("resent", "Samples or fragments that were sent again."),
      json::part<ParticipantResult, &discovery>("discovery", "How participants and endpoints found one another."),
      json::output<&ParticipantResult::deadlines_missed>("deadlines_missed", "Deadlines of instances."),
      json::output<&ParticipantResult::liveliness_lost>("liveliness_lost", "Writers that were taken for dead."),
      json::output<&ParticipantResult::samples_rejected>("samples_rejected", "Samples for which there was no room."),
      json::output<&ParticipantResult::writes_timed_out>("writes_timed_out",
                                                         "Samples that waited for room for too long."),
      json::output<&ParticipantResult::incompatible>("incompatible",
                                                     "Endpoints that did not match, and why; each reason once."),
  };
  static constexpr json::Record record{"participant", "A participant of DDS.", outputs};
  return record;
}

const json::Record& describe(json::Type<BufferResult>) {
  static constexpr json::Output outputs[] = {
      json::output<&BufferResult::received>(
          "received", "Samples that came. received = forwarded + overwritten + dropped + stale + waiting."),
      json::output<&BufferResult::forwarded>("forwarded", "Samples that went on."),
      json::output<&BufferResult::overwritten>("overwritten", "Samples that newer ones took the place of."),
      json::output<&BufferResult::dropped>("dropped", "Samples for which there was no room."),
      json::output<&BufferResult::stale>("stale", "Samples that were too old to go on."),
      json::output<&BufferResult::not_mapped>("not_mapped", "Samples that could not be mapped."),
      json::part<BufferResult, &age>("age_ps", "How old samples were when they went on."),
  };
  static constexpr json::Record record{"buffer", "The shared buffer of a gateway.", outputs};
  return record;
}

const json::Record& describe(json::Type<KeptResult>) {
  static constexpr json::Output outputs[] = {
      json::output<&KeptResult::received>("received", "Samples, from their writers."),
      json::output<&KeptResult::restored>("restored", "Samples that its last start found in its storage."),
      json::output<&KeptResult::kept>("kept", "Samples at the end."),
  };
  static constexpr json::Record record{"kept", "A topic that a persistence service keeps.", outputs};
  return record;
}

const json::Record& describe(json::Type<ApplicationResult>) {
  static constexpr json::Output outputs[] = {
      json::output<&ApplicationResult::node>("node", "Where it runs."),
      json::output<&kind_of>("kind", "`application`, `gateway` or `persistence`."),
      json::outputs_by_name<&ApplicationResult::threads, &ThreadResult::name>("threads", "Its threads.",
                                                                              {.keys = "thread"}),
      json::only_if<&has_buffer>(
          json::output<&ApplicationResult::buffer>("buffer", "Its shared buffer.", {.counts_from_start = true}),
          "of a gateway"),
      json::only_if<&ApplicationResult::is_service>(
          json::outputs_by_name<&ApplicationResult::kept, &KeptResult::topic>(
              "kept", "What it keeps.", {.keys = "topic", .counts_from_start = true}),
          "of a persistence service"),
      json::output_if_any<&ApplicationResult::participants>("participants", "Its participants of DDS.", "with DDS",
                                                            {.counts_from_start = true}),
  };
  static constexpr json::Record record{
      "application", "An application, a gateway or a persistence service. See docs/applications.md.", outputs};
  return record;
}

const json::Record& describe(json::Type<SignalResult>) {
  static constexpr json::Output outputs[] = {
      json::output<&SignalResult::nominal>("nominal_ps", "Length of a pulse; a period is twice that."),
      json::output<&SignalResult::pulses>("pulses_ps", "Pulses; null without one."),
      json::output<&SignalResult::periods>("periods_ps", "From rise to rise; null without one."),
      json::output<&SignalResult::irregular_pulses>("irregular_pulses", "Pulses that are more than 10 % off."),
      json::output<&SignalResult::irregular_periods>("irregular_periods", "Periods that are more than 10 % off."),
      json::output<&SignalResult::irregular_percent>("irregular_percent", "Share of all pulses; null without one.",
                                                     {.unit = "%"}),
  };
  static constexpr json::Record record{"signal", "A digital output, in true time.", outputs};
  return record;
}

}  // namespace takt::results
