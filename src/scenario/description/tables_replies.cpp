// The vocabulary of replies: process data that answers process data, and how long a host works before it does. See description_tables.cpp.
#include "scenario/description/description.hpp"
#include "vocabulary/limits.hpp"

namespace takt::scenario {

using json::optional;
using json::required;
using vocabulary::longest_step;

const json::Object& describe(json::Type<LatencyTail>) {
  static constexpr json::Field fields[] = {
      required<&LatencyTail::from>("from", "The least rare value.", {.max = longest_step}),
      required<&LatencyTail::to>("to", "The greatest rare value.", {.max = longest_step}),
      optional<&LatencyTail::per_million>("per_million", "How many of a million values are rare ones.", {.min = 0.001, .max = 1e6}),
  };
  static constexpr json::Object table = json::object<LatencyTail>("latency_tail", "Rare values, all of an interval equally likely.", fields);
  return table;
}

const json::Object& describe(json::Type<Processing>) {
  static constexpr json::Field fields[] = {
      optional<&Processing::per_message>("per_message", "For each message."),
      optional<&Processing::per_field>("per_field", "Besides, for each value in it; drawn once for a message."),
  };
  static constexpr json::Object table =
      json::object<Processing>("processing", "How long the application of a Program works at process data before it replies; one message after the other.", fields);
  return table;
}

const json::Object& describe(json::Type<Reply>) {
  static constexpr json::Field fields[] = {
      required<&Reply::to>("to", "The process data that is answered; published every cycle."),
      required<&Reply::with>("with", "The process data that answers it: published when the host has processed the other, and then only."),
  };
  static constexpr json::Object table = json::object<Reply>("reply", "Process data that answers other process data at once; the round trip is measured.", fields);
  return table;
}

}  // namespace takt::scenario
