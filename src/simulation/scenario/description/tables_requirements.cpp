// SPDX-License-Identifier: Apache-2.0
// The vocabulary of requirements. See tables.cpp.
#include "plant/limits.hpp"
#include "scenario/description/description.hpp"

namespace takt::scenario {
namespace {

using json::name;
using json::optional;
using plant::longest;

void decode_tolerance(const json::Node& node, Tolerance& value, json::Reader& reader) {
  value = {reader.source(node), {}, 0};
  if (node.kind == json::Kind::string)
    json::decode_value(node, value.time.emplace(), reader);
  else if (node.kind == json::Kind::number)
    json::decode_value(node, value.number, reader);
  else
    reader.wrong_type(node, "a duration such as \"7ms\", or a number");
  if (value.time && *value.time > longest) reader.error(node, "too long", {json::quote(node.text), "at most 100 days"});
  if (value.number < 0) reader.error(node, "negative", {json::excerpt(node), "a number from 0 on"});
}
json::Node encode_tolerance(const Tolerance& value) {
  return value.time ? json::encode_value(*value.time) : json::encode_value(value.number);
}
json::Node schema_tolerance(json::SchemaBuilder& builder) {
  json::Node any = json::Node::array();
  any.items.push_back(json::schema_value<Duration>(builder, {.max = longest}));
  any.items.push_back(json::schema_value<double>(builder, {.min = 0.0}));
  json::Node schema = json::Node::object();
  schema.add("anyOf", std::move(any));
  return schema;
}

}  // namespace

const json::Custom& describe(json::Type<Tolerance>) {
  static constexpr json::Custom table = json::custom<Tolerance, decode_tolerance, encode_tolerance, schema_tolerance>();
  return table;
}

const json::Object& describe(json::Type<DurationLimit>) {
  static constexpr json::Field fields[] = {
      optional<&DurationLimit::at_most>("at_most", "The longest that it may be.", {.max = longest}),
      optional<&DurationLimit::equal>("equal", "What it must be, the shortest as the longest, within within.",
                                      {.max = longest}),
      optional<&DurationLimit::within>("within", "How far they may be from equal, either way; 0s if absent.",
                                       {.max = longest}),
  };
  static constexpr std::string_view bounds[] = {"at_most", "equal"};
  static constexpr json::Group groups[] = {json::exactly_one_of(bounds)};
  static constexpr json::Object table =
      json::object<DurationLimit>("duration_limit", "What a time may be: a duration is the longest.", fields,
                                  {.groups = groups, .shorthand = "at_most"});
  return table;
}

const json::Enumeration& describe(json::Type<Reaction>) {
  static constexpr json::EnumName names[] = {
      name(Reaction::start, "start", "until all are Running"),
      name(Reaction::halt, "halt", "until all are Halted"),
      name(Reaction::suspend, "suspend", "until all are Suspended"),
      name(Reaction::resume, "resume", "until all are Running again"),
      name(Reaction::reset, "reset", "until all are Ready"),
  };
  static constexpr json::Enumeration table = json::enumeration<Reaction>("a reaction", names);
  return table;
}

const json::Object& describe(json::Type<Requirement>) {
  static constexpr json::Field fields[] = {
      optional<&Requirement::name>("name",
                                   "How plans and reports call it, such as REQ-12; no other requirement is called so.",
                                   {.min_length = 1, .max_length = 100}),
      optional<&Requirement::reaction>(
          "reaction", "Every such reaction ends within the time given by within, and there is at least one."),
      optional<&Requirement::program>("program", "Only of this program."),
      optional<&Requirement::cause>("cause", "Only what this has caused; whatever the cause if absent."),
      optional<&Requirement::within>("within",
                                     "Longest reaction, from the instant of its cause until all living participants "
                                     "are there; greatest difference of clocks; how far a figure may be from equal, a "
                                     "number in its unit or a duration (0 if absent)."),
      optional<&Requirement::tree>(
          "tree", "The reaction of the program and all that are nested in it: until everybody in the tree is there."),
      optional<&Requirement::stream>("stream", "The stream that is meant."),
      optional<&Requirement::latency>(
          "latency",
          "Longest time from production to delivery. A frame that is lost, or that is under way for longer at the end, "
          "breaks it; losses do not if dropped or delivered says how many there may be."),
      optional<&Requirement::jitter>("jitter",
                                     "Largest difference between two latencies; lost frames count as for latency."),
      optional<&Requirement::dropped>(
          "dropped",
          "Most frames that may be lost. Of a redundant stream a frame is lost if none of its copies arrives."),
      optional<&Requirement::delivered>("delivered", "Fewest frames that must be delivered."),
      optional<&Requirement::lost_in_a_row>("lost_in_a_row", "Most frames that may be lost one after another."),
      optional<&Requirement::late_in_a_row>(
          "late_in_a_row",
          "Most frames or reactions one after another that may be later than deadline, or never come."),
      optional<&Requirement::met>(
          "met",
          "Of any so many one after another as of says, at least so many come: within deadline, if there is one."),
      optional<&Requirement::of>("of", "Of how many one after another met is.", {.min = 1, .max = 1'000'000}),
      optional<&Requirement::deadline>("deadline",
                                       "What takes longer is late, for late_in_a_row and met: from production to "
                                       "delivery of a frame, from cause to end of a reaction.",
                                       {.max = longest}),
      optional<&Requirement::sync>("sync",
                                   "Greatest difference between a node's clock and that of the grandmaster, either "
                                   "way; all nodes with gPTP follow one grandmaster.",
                                   {.max = longest}),
      optional<&Requirement::node>("node", "Only of this node; of all with gPTP if absent."),
      optional<&Requirement::clocks>(
          "clocks", "Nodes, any two of whose clocks differ by at most within, whomever they follow; \"*\": all nodes."),
      optional<&Requirement::given>("given",
                                    "With sync or clocks: a data sheet promises it. What rests on it is proved on that "
                                    "condition; a run that shows more refutes it."),
      optional<&Requirement::application>("application", "The application or gateway that is meant."),
      optional<&Requirement::thread>("thread", "One of its threads; each of them that the limit concerns if absent."),
      optional<&Requirement::success>("success",
                                      "Least share of the expected calls that took place (criterion 1), in percent.",
                                      {.min = 0, .max = 100}),
      optional<&Requirement::buffered>(
          "buffered",
          "Least share of the expected values that a subscribing thread buffered (criterion 2), in percent.",
          {.min = 0, .max = 100}),
      optional<&Requirement::signal>("signal", "The digital output that is meant."),
      optional<&Requirement::irregular>("irregular",
                                        "Greatest share of pulses whose length is more than 10 % off, in percent.",
                                        {.min = 0, .max = 100}),
      optional<&Requirement::figure>(
          "figure",
          "Any figure of result.json: a JSON pointer, * for every member, or a short form such as reaction.start.max.",
          {.min_length = 2, .max_length = 1000}),
      optional<&Requirement::only>("only",
                                   "Members that the object with the figure must have, such as {\"kind\": \"start\"}."),
      optional<&Requirement::take>("take", "What is taken if the pointer leads to several values; max if absent."),
      optional<&Requirement::unit>("unit",
                                   "In which a number of at_most or at_least is: ps, ns, us, ms or s for times, % for "
                                   "shares, otherwise a label.",
                                   {.max_length = 20}),
      optional<&Requirement::at_most>("at_most",
                                      "The greatest that the figure may be: a number, or a duration such as 7ms."),
      optional<&Requirement::at_least>("at_least", "The least that it may be."),
      optional<&Requirement::equal>("equal", "What it must be, within within."),
      optional<&Requirement::after>(
          "after", "What begins at this instant or later counts; the scenario's warm_up if absent.", {.max = longest}),
  };
  static constexpr std::string_view subjects[] = {"reaction",    "stream", "sync",  "clocks",
                                                  "application", "signal", "figure"};
  static constexpr std::string_view bounds[] = {"at_most", "at_least", "equal"};
  static constexpr json::Group groups[] = {json::exactly_one_of(subjects), json::at_most_one_of(bounds)};
  static constexpr json::Object table =
      json::object<Requirement>("requirement", "What the run must show.", fields, {.groups = groups});
  return table;
}

}  // namespace takt::scenario
