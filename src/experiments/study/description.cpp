// SPDX-License-Identifier: Apache-2.0
// The vocabulary of study files: for each struct of description.hpp the table of its fields.
#include "study/description.hpp"

#include "json/prose.hpp"

namespace takt::study {
namespace {

using namespace sim::literals;  // NOLINT: units in limits
using json::name;
using json::optional;
using json::required;

constexpr std::size_t most_levels = 100'000;

}  // namespace

const json::Object& describe(json::Type<Setting>) {
  static constexpr json::Field fields[] = {
      required<&Setting::at>("at", "JSON pointer into the scenario.", {.min_length = 2, .max_length = 1000}),
      optional<&Setting::as>("as", "A text in which {} stands for the level, such as sw{}.", {.max_length = 1000}),
      optional<&Setting::each>("each", "The level is a count: an array of so many texts, {} counts from \"first\".",
                               {.max_length = 1000}),
      optional<&Setting::first>("first", "What {} is in the first text of \"each\"."),
  };
  static constexpr std::string_view kinds[] = {"as", "each"};
  static constexpr json::Group groups[] = {json::at_most_one_of(kinds)};
  static constexpr json::Object table = json::object<Setting>("setting", "A place of the scenario that a factor sets.",
                                                              fields, {.groups = groups, .shorthand = "at"});
  return table;
}

const json::Enumeration& describe(json::Type<Scale>) {
  static constexpr json::EnumName names[] = {
      name(Scale::linear, "linear", "equal differences"),
      name(Scale::logarithmic, "log", "equal ratios"),
  };
  static constexpr json::Enumeration table = json::enumeration<Scale>("a scale", names);
  return table;
}

const json::Object& describe(json::Type<Range>) {
  static constexpr json::Field fields[] = {
      required<&Range::from>("from", "The first level, an integer or a quantity."),
      required<&Range::to>("to", "The last level, of the same kind."),
      optional<&Range::step>("step", "From level to level; 1 for integers if neither it nor \"steps\" is given."),
      optional<&Range::steps>("steps", "Number of levels.", {.min = 2, .max = most_levels}),
      optional<&Range::scale>("scale", "How levels are spaced, or drawn by random designs."),
  };
  static constexpr std::string_view kinds[] = {"step", "steps"};
  static constexpr json::Group groups[] = {json::at_most_one_of(kinds)};
  static constexpr json::Object table =
      json::object<Range>("range", "Levels between two ends.", fields, {.groups = groups});
  return table;
}

const json::Object& describe(json::Type<LinkFailures>) {
  static constexpr json::Field fields[] = {
      optional<&LinkFailures::at_once>("at_once", "1: every link alone; 2: every pair of links as well.",
                                       {.min = 1, .max = 2}),
      required<&LinkFailures::at>("at", "When the links fail.", {.max = 1'000'000_s}),
      optional<&LinkFailures::lasts>("for", "How long they are down; to the end if absent.",
                                     {.min = 1_ns, .max = 1'000'000_s}),
  };
  static constexpr json::Object table = json::object<LinkFailures>(
      "link_failures", "Failures of links between switches, of whatever topology the other factors make.", fields);
  return table;
}

const json::Object& describe(json::Type<GraphmlLevel>) {
  static constexpr json::Field fields[] = {
      required<&GraphmlLevel::graphml>("graphml", "A GraphML file beside the study."),
      optional<&GraphmlLevel::hosts_per_switch>(
          "hosts_per_switch", "Hosts h1, h2 ... at each switch, besides those of the file.", {.max = 1000}),
      optional<&GraphmlLevel::os>("os", "The operating system of the hosts."),
      optional<&GraphmlLevel::rate>("rate", "Of all links that do not say it."),
      optional<&GraphmlLevel::length>("length", "Of all links that do not say it."),
      optional<&GraphmlLevel::forwarding_delay>("forwarding_delay", "Of all switches."),
  };
  static constexpr json::Object table =
      json::object<GraphmlLevel>("graphml_level", "A network that is drawn in a file.", fields);
  return table;
}

namespace {

void decode_level(const json::Node& node, TopologyLevel& level, json::Reader& reader) {
  if (node.kind == json::Kind::object && node.find("graphml") != nullptr)
    json::decode_value(node, level.from.emplace<GraphmlLevel>(), reader);
  else
    json::decode_value(node, level.from.emplace<scenario::Generator>(), reader);
}
json::Node encode_level(const TopologyLevel& level) {
  return std::visit([](const auto& each) { return json::encode_value(each); }, level.from);
}
json::Node schema_of_level(json::SchemaBuilder& builder) {
  json::Node either = json::Node::array();
  either.items = {json::schema_value<scenario::Generator>(builder), json::schema_value<GraphmlLevel>(builder)};
  json::Node schema = json::Node::object();
  schema.add("anyOf", std::move(either));
  return schema;
}

}  // namespace

const json::Custom& describe(json::Type<TopologyLevel>) {
  static constexpr json::Custom table = json::custom<TopologyLevel, decode_level, encode_level, schema_of_level>();
  return table;
}

const json::Object& describe(json::Type<Factor>) {
  static constexpr json::Field fields[] = {
      required<&Factor::name>("name", "Unique; letters, digits and _.", {.min_length = 1, .max_length = 60}),
      optional<&Factor::set>("set", "What \"values\" or \"range\" set.", {.max_items = 100}),
      optional<&Factor::values>("values", "The levels.", {.min_items = 1, .max_items = most_levels}),
      optional<&Factor::range>("range", "The levels, from one to another."),
      optional<&Factor::patches>("patches", "Named levels, each an object of JSON pointers and what is put there.",
                                 {.min_items = 1, .max_items = 1000}),
      optional<&Factor::topologies>("topologies", "Named levels, each a network that replaces that of the scenario.",
                                    {.min_items = 1, .max_items = 1000}),
      optional<&Factor::link_failures>("link_failures",
                                       "The levels are no failure and the failures of links between switches."),
      optional<&Factor::baseline>("baseline", "The level that is kept while another factor varies (one-at-a-time)."),
  };
  static constexpr std::string_view kinds[] = {"values", "range", "patches", "topologies", "link_failures"};
  static constexpr json::Group groups[] = {json::exactly_one_of(kinds)};
  static constexpr json::Object table =
      json::object<Factor>("factor", "Something that varies.", fields, {.groups = groups});
  return table;
}

const json::Enumeration& describe(json::Type<DesignKind>) {
  static constexpr json::EnumName names[] = {
      name(DesignKind::grid, "grid", "every combination"),
      name(DesignKind::random, "random", "each factor drawn for itself"),
      name(DesignKind::latin_hypercube, "latin-hypercube", "random, but each factor's range is covered evenly"),
      name(DesignKind::one_at_a_time, "one-at-a-time", "the baseline, and each other level of each factor alone"),
  };
  static constexpr json::Enumeration table = json::enumeration<DesignKind>("a design", names);
  return table;
}

const json::Object& describe(json::Type<Design>) {
  static constexpr json::Field fields[] = {
      optional<&Design::kind>("kind", "Which combinations of levels are run."),
      optional<&Design::points>("points", "How many combinations random designs draw.", {.min = 1, .max = 1'000'000}),
      optional<&Design::seed>("seed", "The seed of random designs."),
  };
  static constexpr json::Object table =
      json::object<Design>("design", "Which combinations of levels are run.", fields, {.shorthand = "kind"});
  return table;
}

const json::Object& describe(json::Type<Measure>) {
  static constexpr json::Field fields[] = {
      required<&Measure::name>("name", "Unique; letters, digits and _.", {.min_length = 1, .max_length = 60}),
      required<&Measure::of>(
          "of",
          "A JSON pointer into result.json, * for every member; or a short form such as reaction.start.max. Of the "
          "verification of the variant: worst.X and bound.X, where X is a greatest latency or reaction "
          "(worst.reaction.halt.max), and verdict (1: proved, 0: refuted, none: undecided). Of a study of schedules: "
          "scheduled, infeasible, undecided, left_over, busiest_link, normalised_latency or waiting.",
          {.min_length = 2, .max_length = 1000}),
      optional<&Measure::only>("only", "Members that objects on the way must have."),
      optional<&Measure::take>("take", "What is taken if there are several values."),
      optional<&Measure::unit>("unit", "ps, ns, us, ms or s for times, % for shares, otherwise a label.",
                               {.max_length = 20}),
  };
  static constexpr json::Object table = json::object<Measure>("measure", "A figure of each run.", fields);
  return table;
}

const json::Object& describe(json::Type<Limit>) {
  static constexpr json::Field fields[] = {
      required<&Limit::measure>("measure", "The name of a measure."),
      optional<&Limit::at_most>("at_most", "A number in the measure's unit, or a duration."),
      optional<&Limit::at_least>("at_least", "A number in the measure's unit, or a duration."),
  };
  static constexpr std::string_view kinds[] = {"at_most", "at_least"};
  static constexpr json::Group groups[] = {json::exactly_one_of(kinds)};
  static constexpr json::Object table =
      json::object<Limit>("limit", "What a point must keep to pass.", fields, {.groups = groups});
  return table;
}

const json::Object& describe(json::Type<Replications>) {
  static constexpr json::Field fields[] = {
      optional<&Replications::count>(
          "count", "Runs of each variant, with seeds one after the other; all variants have the same seeds.",
          {.min = 1, .max = 100'000}),
      optional<&Replications::first_seed>("first_seed", "The seed of the first run."),
  };
  static constexpr json::Object table =
      json::object<Replications>("replications", "How often each variant runs.", fields, {.shorthand = "count"});
  return table;
}

const json::Object& describe(json::Type<Verifying>) {
  static constexpr json::Field fields[] = {
      optional<&Verifying::budget>("budget",
                                   "What the search for the worst run may cost at each point, in millions of events.",
                                   {.min = 0, .max = 1'000'000}),
      optional<&Verifying::seeds>("seeds",
                                  "Runs of the scenario as it is, before the search, each with a seed of its own.",
                                  {.min = 1, .max = 100'000}),
  };
  static constexpr json::Object table = json::object<Verifying>(
      "verifying",
      "How variants are verified, if a measure is worst.X, bound.X or verdict, or --find asks for a greatest time.",
      fields);
  return table;
}

const json::Object& describe(json::Type<Effort>) {
  static constexpr json::Field fields[] = {
      optional<&Effort::cpu>("cpu", "CPU time of one run, such as 60s.", {.min = 1_ms, .max = 1'000'000_s}),
      optional<&Effort::memory>("memory", "Memory of one run, such as 512MiB.", {.min = sim::Octets{16'777'216}}),
  };
  static constexpr json::Object table = json::object<Effort>(
      "effort", "What one run may take; more is an error of that point, and the study goes on.", fields);
  return table;
}

const json::Enumeration& describe(json::Type<Impossible>) {
  static constexpr json::EnumName names[] = {
      name(Impossible::refused, "refused", "a variant that is no sound scenario is a mistake of the study"),
      name(Impossible::recorded, "recorded",
           "it is a point that cannot be, with its reason (an overloaded link, a gate that is too short)"),
  };
  static constexpr json::Enumeration table = json::enumeration<Impossible>("a rule for variants that cannot be", names);
  return table;
}

const json::Object& describe(json::Type<DrawnStreams>) {
  static constexpr json::Field fields[] = {
      optional<&DrawnStreams::count>("count", "How many. Fewer are the first of more.", {.min = 1, .max = 100'000}),
      optional<&DrawnStreams::every>("every", "Periods, one of which each stream has.",
                                     {.min_items = 1, .max_items = 100, .items = {.min = 1_us, .max = 10_s}}),
      optional<&DrawnStreams::payload>("payload", "Octets of user data, before IPv4 and UDP headers are added.",
                                       {.min_items = 1, .max_items = 100, .items = {.max = sim::Octets{1472}}}),
      optional<&DrawnStreams::latency>("latency",
                                       "Longest times from the start at the talker to the end at the listener; as long "
                                       "as it takes if there is none.",
                                       {.max_items = 100, .items = {.min = 1_us, .max = 10_s}}),
  };
  static constexpr json::Object table = json::object<DrawnStreams>(
      "drawn_streams", "Streams between hosts that are drawn, with a period, a payload and a latency of the lists.",
      fields);
  return table;
}

const json::Enumeration& describe(json::Type<SearchedRoutes>) {
  static constexpr json::EnumName names[] = {
      name(SearchedRoutes::shortest, "shortest",
           "one way for each stream: of the shortest ones that over the least loaded links"),
      name(SearchedRoutes::search, "search", "other ways, too"),
  };
  static constexpr json::Enumeration table = json::enumeration<SearchedRoutes>("a choice of routes", names);
  return table;
}

const json::Object& describe(json::Type<Scheduling>) {
  static constexpr json::Field fields[] = {
      optional<&Scheduling::streams>("streams", "What is scheduled."),
      optional<&Scheduling::routes>("routes", "Which ways streams may take."),
      optional<&Scheduling::waiting>("waiting", "Whether frames may wait in bridges."),
      optional<&Scheduling::margin>("margin", "Clocks of two nodes differ by at most this.", {.max = 1_ms}),
      optional<&Scheduling::attempts>(
          "attempts",
          "Attempts of the search before a point is undecided; times do not count, so that all machines find the same.",
          {.min = 1, .max = 1'000'000}),
  };
  static constexpr json::Object table = json::object<Scheduling>("scheduling", "How points are scheduled.", fields);
  return table;
}

const json::Object& describe(json::Type<SchedulingPart>) {
  static constexpr json::Field fields[] = {
      required<&SchedulingPart::schedule>("schedule", "How points are scheduled."),
  };
  static constexpr json::Object table = json::object<SchedulingPart>(
      "scheduling_part", "What factors of a study of schedules vary besides the scenario.", fields);
  return table;
}

const json::Object& describe(json::Type<Study>) {
  static constexpr json::Field fields[] = {
      optional<&Study::schema>("$schema", "The JSON Schema, for editors."),
      required<&Study::name>("name", "The name of the study.", {.min_length = 1, .max_length = 200}),
      json::optional_prose<&Study::description>("description", "What it asks."),
      optional<&Study::base>("base", "The scenario file that is varied, beside the study."),
      optional<&Study::scenario>("scenario", "The scenario that is varied, in place of a file."),
      optional<&Study::schedule>("schedule",
                                 "Points are not run: streams are drawn on the network of the scenario and scheduled "
                                 "as takt schedule does it. Pointers of factors that begin with /schedule lead here."),
      required<&Study::factors>("factors", "What varies.", {.min_items = 1, .max_items = 100}),
      optional<&Study::design>("design", "Which combinations are run."),
      optional<&Study::constraints>(
          "constraints", "Only combinations for which all of these hold: \"slaves <= 4 * hops\".", {.max_items = 100}),
      optional<&Study::replications>("replications", "Runs of each variant with different seeds."),
      required<&Study::measures>("measures", "What is looked at.", {.min_items = 1, .max_items = 100}),
      optional<&Study::limits>("limits", "What a point must keep to pass.", {.max_items = 100}),
      optional<&Study::requirements_count>("requirements_count",
                                           "Whether a point must meet the scenario's own requirements too."),
      optional<&Study::impossible>("impossible", "What becomes of variants that are no sound scenario."),
      optional<&Study::verify>("verify",
                               "How variants are verified: of measures worst.X, bound.X and verdict, and of --find."),
      optional<&Study::effort>("effort", "What one run may take."),
  };
  static constexpr std::string_view bases[] = {"base", "scenario"};
  static constexpr json::Group groups[] = {json::exactly_one_of(bases)};
  static constexpr json::Object table =
      json::object<Study>("study", "A scenario, what of it varies, and what is looked at.", fields, {.groups = groups});
  return table;
}

}  // namespace takt::study
